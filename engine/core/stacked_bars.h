// Shares of a whole, one bar a row, as a piece of SVG: answers of questionnaires for one.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

struct StackedBars {
    struct Row {
        std::string label;
        std::vector<int> counts;  ///< one a part
    };
    std::string title;
    std::vector<std::string> parts;  ///< names, in the order of the bar from left to right
    std::vector<Row> rows;           ///< a row without a count stays empty
};

/// An <svg> element, complete in itself; from red-brown over grey to blue, which the colour-blind tell apart, with the
/// counts written in.  Throws std::logic_error where a row has not one count a part.
std::string svg_stacked_bars(const StackedBars& bars);

}  // namespace cathlab
