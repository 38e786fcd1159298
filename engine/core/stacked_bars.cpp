#include "core/stacked_bars.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include "core/check.h"
#include "core/svg_plot.h"

namespace cathlab {
namespace {

constexpr double label_width = 330.0, bar_width = 360.0, row_height = 30.0, bar_height = 20.0, top = 52.0;
constexpr std::size_t letters_a_line = 52;

std::string pixel(double value) {
    std::array<char, 64> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 1).ptr;
    return {buffer.data(), end};
}

std::string text(double x, double y, const char* anchor, const std::string& content, const std::string& more = "") {
    return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
           xml_escaped(content) + "</text>\n";
}

struct Shade {
    const char* fill;
    const char* ink;
};

/// Of part k of n: the ends are the darkest.
Shade shade(std::size_t k, std::size_t n) {
    static constexpr std::array<Shade, 5> shades{{{"#a6611a", "#ffffff"},
                                                  {"#dfc27d", "#202020"},
                                                  {"#e0e0e0", "#202020"},
                                                  {"#92c5de", "#202020"},
                                                  {"#0571b0", "#ffffff"}}};
    return n < 2 ? shades[2] : shades[(k * (shades.size() - 1) + (n - 1) / 2) / (n - 1)];
}

std::string rect(double x, double y, double width, double height, const char* fill) {
    return "<rect x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" width=\"" + pixel(width) + "\" height=\"" +
           pixel(height) + "\" fill=\"" + fill + "\" stroke=\"#ffffff\"/>\n";
}

/// A label in one line, or in two, cut at the last blank that fits.
std::string label(double y, const std::string& content) {
    std::size_t cut = std::string::npos;
    if (content.size() > letters_a_line) cut = content.rfind(' ', letters_a_line);
    if (cut == std::string::npos) return text(label_width - 8.0, y + 14.0, "end", content);
    return text(label_width - 8.0, y + 8.0, "end", content.substr(0, cut)) +
           text(label_width - 8.0, y + 21.0, "end", content.substr(cut + 1));
}

}  // namespace

std::string svg_stacked_bars(const StackedBars& bars) {
    const double width = label_width + bar_width + 20.0;
    const double height = top + row_height * static_cast<double>(bars.rows.size()) + 10.0;
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(width) + " " + pixel(height) +
                      "\" width=\"" + pixel(width) + "\" height=\"" + pixel(height) +
                      "\" font-family=\"sans-serif\" font-size=\"12\">\n";
    out += text(0.0, 16.0, "start", bars.title, " font-weight=\"bold\"");
    const double share = bar_width / static_cast<double>(std::max<std::size_t>(1, bars.parts.size()));
    for (std::size_t k = 0; k < bars.parts.size(); ++k) {
        const double x = label_width + static_cast<double>(k) * share;
        out += rect(x, 26.0, 10.0, 10.0, shade(k, bars.parts.size()).fill);
        out += text(x + 14.0, 35.0, "start", bars.parts[k], " font-size=\"10\"");
    }
    for (std::size_t r = 0; r < bars.rows.size(); ++r) {
        const StackedBars::Row& row = bars.rows[r];
        CATHLAB_CHECK(row.counts.size() == bars.parts.size(), "a row of bars has one count a part");
        const double y = top + row_height * static_cast<double>(r);
        out += label(y, row.label);
        const int all = std::accumulate(row.counts.begin(), row.counts.end(), 0);
        double x = label_width;
        for (std::size_t k = 0; k < row.counts.size() && all > 0; ++k) {
            if (row.counts[k] == 0) continue;
            const double w = bar_width * row.counts[k] / all;
            const Shade s = shade(k, row.counts.size());
            out += rect(x, y, w, bar_height, s.fill);
            out += text(x + 0.5 * w, y + 14.0, "middle", std::to_string(row.counts[k]),
                        std::string(" fill=\"") + s.ink + "\"");
            x += w;
        }
    }
    return out + "</svg>\n";
}

}  // namespace cathlab
