// Curves over one axis as a piece of SVG: for reports that are one HTML page.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

/// How a curve is told from the others: by colour (Okabe and Ito's, which the colour-blind tell apart) and, in black
/// and white, by dash and mark.  The numbers of a report keep their style from picture to picture.
enum class CurveStyle { reference, first, best, fourth, fifth };

struct PlotCurve {
    std::string label;         ///< in the legend; empty = not listed
    std::vector<double> x, y;  ///< of one length; a y that is not finite interrupts the line
    CurveStyle style = CurveStyle::best;
    bool marks = false;  ///< a mark at each point
    bool line = true;    ///< points alone otherwise (then with marks)
};

struct Plot {
    std::string title;
    std::string x_label, y_label;  ///< with their units
    std::vector<PlotCurve> curves;
    bool log_y = false;      ///< values that are not above 0 are left out
    bool zero_line = false;  ///< a thin line at y = 0, which then lies within the axis
    int width = 720, height = 360;
};

/// An <svg> element, complete in itself: no script, no font but the reader's, nothing from elsewhere.  A plot without a
/// single finite point says so.  Throws std::logic_error where a curve's x and y differ in length.
std::string svg_plot(const Plot& plot);

/// Round numbers that cut [low, high] into about `count` steps (1, 2 or 5 times a power of ten), those within it.
std::vector<double> round_ticks(double low, double high, int count);

/// A number as people read it: at most `digits` significant ones, no trailing zeros.
std::string plain_number(double value, int digits = 4);

/// & < > " and ' as entities.
std::string xml_escaped(const std::string& text);

}  // namespace cathlab
