#include "core/svg_plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double least_margin_left = 74.0, margin_right = 16.0, margin_top = 52.0, margin_bottom = 52.0;
constexpr int x_steps = 8;
constexpr double letter = 7.6;  // an average one of a wide 12 px font; a digit is as wide

struct Style {
    const char* colour;
    const char* dash;
    int mark;  ///< sides of the mark; 0 = a circle
};

const Style& style_of(CurveStyle style) {
    static constexpr std::array<Style, 5> styles{{{"#000000", "", 0},
                                                  {"#d55e00", "7 4", 4},
                                                  {"#0072b2", "", 3},
                                                  {"#009e73", "2 3", 4},
                                                  {"#cc79a7", "10 3 2 3", 3}}};
    return styles[std::min(static_cast<std::size_t>(style), styles.size() - 1)];
}

std::string pixel(double value) {
    std::array<char, 64> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 1).ptr;
    return {buffer.data(), end};
}

struct Axis {
    double low = 0.0, high = 1.0;    // in numbers, or in their logarithms
    double first = 0.0, last = 1.0;  // the same ends in pixels
    double operator()(double value) const { return first + (value - low) / (high - low) * (last - first); }
};

/// Text with an anchor: start, middle or end.
std::string text(double x, double y, const char* anchor, const std::string& content, const std::string& more = "") {
    return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
           xml_escaped(content) + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, const std::string& stroke) {
    return "<line x1=\"" + pixel(x0) + "\" y1=\"" + pixel(y0) + "\" x2=\"" + pixel(x1) + "\" y2=\"" + pixel(y1) +
           "\" " + stroke + "/>\n";
}

std::string mark(double x, double y, const Style& style) {
    constexpr double r = 3.0;
    const std::string fill = std::string(" fill=\"") + style.colour + "\"/>\n";
    if (style.mark == 0) return "<circle cx=\"" + pixel(x) + "\" cy=\"" + pixel(y) + "\" r=\"" + pixel(r) + "\"" + fill;
    if (style.mark == 4)
        return "<rect x=\"" + pixel(x - r) + "\" y=\"" + pixel(y - r) + "\" width=\"" + pixel(2.0 * r) +
               "\" height=\"" + pixel(2.0 * r) + "\"" + fill;
    return "<path d=\"M" + pixel(x) + " " + pixel(y - 1.3 * r) + "L" + pixel(x - 1.2 * r) + " " + pixel(y + r) + "L" +
           pixel(x + 1.2 * r) + " " + pixel(y + r) + "Z\"" + fill;
}

double shown_y(const Plot& plot, double y) {
    if (!plot.log_y) return y;
    return y > 0.0 ? std::log10(y) : std::numeric_limits<double>::quiet_NaN();
}

/// 1, 2 or 5 times a power of ten, about `count` of which make up the range.
double round_step(double low, double high, int count) {
    const double raw = (high - low) / count;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double nice : {1.0, 2.0, 5.0})
        if (nice * power >= raw * (1.0 - 1e-9)) return nice * power;
    return 10.0 * power;
}

std::vector<double> multiples(double step, double low, double high) {
    std::vector<double> out;
    const double slack = 1e-9 * step;
    constexpr double most = 1e15;  // beyond, k + 1 is k
    if (!(std::max(std::fabs(low), std::fabs(high)) < most * step)) return out;
    for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1.0) out.push_back(k * step);
    return out;
}

/// Steps of the x axis: whole ones where every x is whole, a generation say.
double x_step(const Plot& plot, const Axis& x) {
    const double step = round_step(x.low, x.high, x_steps);
    for (const PlotCurve& curve : plot.curves)
        for (const double value : curve.x)
            if (std::isfinite(value) && value != std::floor(value)) return step;
    return std::max(step, 1.0);
}

/// An end that lies just short of a tick goes there, so that the tick is written.
void reach_ticks(Axis& x, double step) {
    constexpr double near = 0.04;
    const double room = near * (x.high - x.low);
    const double before = std::floor(x.low / step) * step, after = std::ceil(x.high / step) * step;
    if (x.low - before <= room) x.low = before;
    if (after - x.high <= room) x.high = after;
}

// The box of all points; false where there is none.
bool find_box(const Plot& plot, Axis& x, Axis& y) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    x.low = y.low = infinite;
    x.high = y.high = -infinite;
    for (const PlotCurve& curve : plot.curves) {
        CATHLAB_CHECK(curve.x.size() == curve.y.size(), "a curve has as many x as y");
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            const double value = shown_y(plot, curve.y[i]);
            if (!std::isfinite(value) || !std::isfinite(curve.x[i])) continue;
            x.low = std::min(x.low, curve.x[i]);
            x.high = std::max(x.high, curve.x[i]);
            y.low = std::min(y.low, value);
            y.high = std::max(y.high, value);
        }
    }
    if (!(x.low <= x.high)) return false;
    if (plot.zero_line && !plot.log_y) {
        y.low = std::min(y.low, 0.0);
        y.high = std::max(y.high, 0.0);
    }
    // Numbers that differ by their rounding alone are one number.
    const auto one_number = [](const Axis& axis) {
        return axis.high - axis.low <= 1e-12 * std::max(std::fabs(axis.low), std::fabs(axis.high));
    };
    const auto widen = [&](Axis& axis, double share) {
        const double room =
            one_number(axis) ? std::max(1e-9, 0.1 * std::fabs(axis.low)) : share * (axis.high - axis.low);
        axis.low -= room;
        axis.high += room;
    };
    if (one_number(x)) widen(x, 0.0);
    reach_ticks(x, x_step(plot, x));
    widen(y, 0.05);
    return true;
}

std::vector<double> ticks_of(const Axis& axis, bool logarithmic) {
    constexpr int about = 6;
    if (!logarithmic) return round_ticks(axis.low, axis.high, about);
    std::vector<double> out;
    for (double decade = std::floor(axis.low); decade <= axis.high; decade += 1.0)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double at = decade + std::log10(step);
            if (at >= axis.low && at <= axis.high) out.push_back(at);
        }
    if (out.size() > 2) return out;
    out.clear();  // less than a decade
    for (const double tick : round_ticks(std::pow(10.0, axis.low), std::pow(10.0, axis.high), about))
        if (tick > 0.0) out.push_back(std::log10(tick));
    return out;
}

struct Tick {
    double at = 0.0;  // along its axis
    std::string text;
};

/// With as many digits as tell a tick from its neighbour, and not fewer than four.
std::vector<Tick> written(const std::vector<double>& ticks, bool logarithmic) {
    std::vector<double> values = ticks;
    if (logarithmic)
        for (double& value : values) value = std::pow(10.0, value);
    double largest = 0.0, step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < values.size(); ++i) {
        largest = std::max(largest, std::fabs(values[i]));
        if (i > 0) step = std::min(step, values[i] - values[i - 1]);
    }
    constexpr double least = 4.0, most = 12.0;
    const double wanted =
        largest > 0.0 ? std::floor(std::log10(largest)) - std::floor(std::log10(step) + 1e-9) + 1.0 : 0.0;
    const int digits = static_cast<int>(std::clamp(wanted, least, most));
    std::vector<Tick> out;
    for (std::size_t i = 0; i < ticks.size(); ++i) out.push_back({ticks[i], plain_number(values[i], digits)});
    return out;
}

std::string axes(const Plot& plot, const Axis& x, const Axis& y, const std::vector<Tick>& y_ticks) {
    std::string out;
    const std::string grid = "stroke=\"#d8d8d8\" stroke-width=\"1\"";
    constexpr double gap = 6.0, baseline = 4.0;
    for (const Tick& tick : written(multiples(x_step(plot, x), x.low, x.high), false)) {
        out += line(x(tick.at), y.first, x(tick.at), y.last, grid);
        out += text(x(tick.at), y.first + 3.0 * gap, "middle", tick.text);
    }
    for (const Tick& tick : y_ticks) {
        out += line(x.first, y(tick.at), x.last, y(tick.at), grid);
        out += text(x.first - gap, y(tick.at) + baseline, "end", tick.text);
    }
    const std::string frame = "stroke=\"#404040\" stroke-width=\"1\"";
    if (plot.zero_line && !plot.log_y) out += line(x.first, y(0.0), x.last, y(0.0), frame);
    out += line(x.first, y.first, x.last, y.first, frame) + line(x.first, y.first, x.first, y.last, frame);
    out += text(0.5 * (x.first + x.last), y.first + 6.5 * gap, "middle", plot.x_label);
    const double middle = 0.5 * (y.first + y.last);
    out += text(16.0, middle, "middle", plot.y_label, " transform=\"rotate(-90 16 " + pixel(middle) + ")\"");
    return out;
}

std::string draw(const Plot& plot, const PlotCurve& curve, const Axis& x, const Axis& y) {
    const Style& style = style_of(curve.style);
    std::string path, marks;
    bool pen = false;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double value = shown_y(plot, curve.y[i]);
        if (!std::isfinite(value) || !std::isfinite(curve.x[i])) {
            pen = false;
            continue;
        }
        const double px = x(curve.x[i]), py = y(value);
        path += (pen ? "L" : "M") + pixel(px) + " " + pixel(py);
        pen = true;
        if (curve.marks || !curve.line) marks += mark(px, py, style);
    }
    if (path.empty()) return "";
    const std::string dash = *style.dash == '\0' ? "" : std::string(" stroke-dasharray=\"") + style.dash + "\"";
    std::string out;
    if (curve.line)
        out += "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + style.colour + "\" stroke-width=\"1.8\"" + dash +
               "/>\n";
    return out + marks;
}

/// Characters of a UTF-8 text.
std::size_t letters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string legend(const Plot& plot) {
    std::string out;
    double at = least_margin_left;
    constexpr double y = margin_top - 14.0, length = 26.0;
    for (const PlotCurve& curve : plot.curves) {
        if (curve.label.empty()) continue;
        const Style& style = style_of(curve.style);
        const std::string dash = *style.dash == '\0' ? "" : std::string(" stroke-dasharray=\"") + style.dash + "\"";
        if (curve.line)
            out +=
                line(at, y, at + length, y, std::string("stroke=\"") + style.colour + "\" stroke-width=\"1.8\"" + dash);
        if (curve.marks || !curve.line) out += mark(at + 0.5 * length, y, style);
        out += text(at + length + 6.0, y + 4.0, "start", curve.label);
        constexpr double gap = 30.0;
        at += length + gap + letter * static_cast<double>(letters(curve.label));
    }
    return out;
}

}  // namespace

std::string xml_escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            case '\'': out += "&#39;"; break;
            default: out += c;
        }
    }
    return out;
}

std::string plain_number(double value, int digits) {
    if (!std::isfinite(value)) return "none";
    if (value == 0.0) return "0";  // also -0
    std::array<char, 64> buffer{};
    const double size = std::fabs(value);
    const bool power = size < 1e-4 || size >= 1e7;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                      power ? std::chars_format::scientific : std::chars_format::general, power ? digits - 1 : digits)
            .ptr;
    std::string out(buffer.data(), end);
    if (!power && out.find('e') != std::string::npos) {  // general form took to powers for want of digits
        const auto whole =
            std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 0).ptr;
        out.assign(buffer.data(), whole);
    }
    const auto exponent = out.find('e');
    std::string mantissa = out.substr(0, exponent);
    if (mantissa.find('.') != std::string::npos) {
        mantissa.erase(mantissa.find_last_not_of('0') + 1);
        if (mantissa.back() == '.') mantissa.pop_back();
    }
    return mantissa + (exponent == std::string::npos ? "" : out.substr(exponent));
}

std::vector<double> round_ticks(double low, double high, int count) {
    if (!(high > low) || !std::isfinite(high - low) || count < 1) return {};
    return multiples(round_step(low, high, count), low, high);
}

std::string svg_plot(const Plot& plot) {
    const double width = plot.width, height = plot.height;
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(width) + " " + pixel(height) +
                      "\" width=\"" + pixel(width) + "\" height=\"" + pixel(height) +
                      "\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#202020\">\n<title>" +
                      xml_escaped(plot.title) + "</title>\n";
    out += "<rect width=\"" + pixel(width) + "\" height=\"" + pixel(height) + "\" fill=\"#ffffff\"/>\n";
    out += text(least_margin_left, 18.0, "start", plot.title, " font-weight=\"bold\" font-size=\"14\"");
    Axis x, y;
    if (!find_box(plot, x, y)) return out + text(0.5 * width, 0.5 * height, "middle", "no points") + "</svg>\n";
    const std::vector<Tick> y_ticks = written(ticks_of(y, plot.log_y), plot.log_y);
    std::size_t longest = 0;
    for (const Tick& tick : y_ticks) longest = std::max(longest, tick.text.size());
    constexpr double y_name = 34.0;  // the axis' name and what is free round the numbers
    x.first = std::max(least_margin_left, y_name + letter * static_cast<double>(longest));
    x.last = width - margin_right;
    y.first = height - margin_bottom;
    y.last = margin_top;
    out += axes(plot, x, y, y_ticks);
    for (const PlotCurve& curve : plot.curves) out += draw(plot, curve, x, y);
    return out + legend(plot) + "</svg>\n";
}

}  // namespace cathlab
