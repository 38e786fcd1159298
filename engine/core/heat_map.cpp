#include "core/heat_map.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/check.h"
#include "core/svg_plot.h"

namespace cathlab {
namespace {

constexpr double left = 64.0, top = 44.0, width = 560.0, row_height = 14.0, bottom = 46.0, scale_width = 14.0;
constexpr int x_ticks = 8, y_ticks = 4, scale_cells = 32;

std::string pixel(double value) {
    std::array<char, 64> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 1).ptr;
    return {buffer.data(), end};
}

/// From a light orange to a dark red-brown.
std::string colour(double share) {
    const double s = std::clamp(share, 0.0, 1.0);
    const auto mix = [&](double light, double dark) {
        return std::to_string(static_cast<int>(std::lround(light + s * (dark - light))));
    };
    return "rgb(" + mix(254.0, 90.0) + "," + mix(232.0, 12.0) + "," + mix(200.0, 12.0) + ")";
}

std::string text(double x, double y, const char* anchor, const std::string& content, const std::string& more = "") {
    return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
           xml_escaped(content) + "</text>\n";
}

std::string cell(double x, double y, double w, double h, const std::string& fill) {
    return "<rect x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" width=\"" + pixel(w) + "\" height=\"" + pixel(h) +
           "\" fill=\"" + fill + "\"/>\n";
}

}  // namespace

std::string svg_heat_map(const HeatMap& map) {
    CATHLAB_CHECK(map.columns >= 0 && map.rows >= 0 &&
                      map.values.size() == static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                  "a heat map has columns * rows values");
    double most = map.most;
    if (most <= 0.0)
        for (const double v : map.values)
            if (std::isfinite(v)) most = std::max(most, v);
    const double height = row_height * map.rows, total = top + height + bottom;
    const double all = left + width + 110.0;
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(all) + " " + pixel(total) +
                      "\" width=\"" + pixel(all) + "\" height=\"" + pixel(total) +
                      "\" font-family=\"sans-serif\" font-size=\"12\">\n";
    out += text(left, 20.0, "start", map.title, " font-weight=\"bold\"");
    if (most <= 0.0 || map.columns == 0) return out + text(left, top, "start", "nothing to show") + "</svg>\n";
    const double w = width / map.columns;
    for (int r = 0; r < map.rows; ++r)
        for (int c = 0; c < map.columns; ++c) {
            const double v = map.values[static_cast<std::size_t>(r) * static_cast<std::size_t>(map.columns) +
                                        static_cast<std::size_t>(c)];
            if (std::isfinite(v) && v > 0.0)
                out += cell(left + c * w, top + r * row_height, w, row_height, colour(v / most));
        }
    out += "<rect x=\"" + pixel(left) + "\" y=\"" + pixel(top) + "\" width=\"" + pixel(width) + "\" height=\"" +
           pixel(height) + "\" fill=\"none\" stroke=\"#606060\"/>\n";
    const double x_most = map.columns * map.x_step, y_most = map.rows * map.y_step;
    for (const double tick : round_ticks(0.0, x_most, x_ticks))
        out += text(left + tick / x_most * width, top + height + 16.0, "middle", plain_number(tick));
    for (const double tick : round_ticks(0.0, y_most, y_ticks))
        out += text(left - 6.0, top + tick / y_most * height + 4.0, "end", plain_number(tick));
    out += text(left + 0.5 * width, top + height + 36.0, "middle", map.x_label);
    out += text(16.0, top + 0.5 * height, "middle", map.y_label,
                " transform=\"rotate(-90 16 " + pixel(top + 0.5 * height) + ")\"");
    const double scale_x = left + width + 16.0, step = height / scale_cells;
    for (int k = 0; k < scale_cells; ++k)
        out += cell(scale_x, top + height - (k + 1) * step, scale_width, step + 0.5, colour((k + 0.5) / scale_cells));
    out += text(scale_x + scale_width + 5.0, top + 9.0, "start", plain_number(most, 2));
    out += text(scale_x + scale_width + 5.0, top + height, "start", "0");
    out += text(scale_x, top - 10.0, "start", map.value_label);
    return out + "</svg>\n";
}

}  // namespace cathlab
