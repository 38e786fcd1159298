// A table of values as coloured cells, as a piece of SVG: for reports that are one HTML page.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

struct HeatMap {
    std::string title;
    std::string x_label, y_label;       ///< with their units
    std::string value_label;            ///< of the scale beside it, with its unit
    double x_step = 1.0, y_step = 1.0;  ///< a cell's width and height, from 0 on; x runs along the page
    int columns = 0, rows = 0;
    std::vector<double> values;  ///< row after row, columns * rows; what is not finite or not above 0 stays white
    double most = 0.0;           ///< darkest; 0 = the largest value
};

/// An <svg> element, complete in itself.  One hue from light to dark, so that it reads in black and white and by the
/// colour-blind too.  Throws std::logic_error where the values are not columns * rows.
std::string svg_heat_map(const HeatMap& map);

}  // namespace cathlab
