// A report as one HTML page that holds everything it shows: no script, nothing from elsewhere, ready for the printer.
#pragma once

#include <string>
#include <vector>

#include "core/heat_map.h"
#include "core/stacked_bars.h"
#include "core/svg_plot.h"

namespace cathlab {

struct PageTable {
    std::string caption;
    std::vector<std::string> header;             ///< one a column; no header where all are empty
    std::vector<std::vector<std::string>> rows;  ///< the first cell of a row names it
    std::vector<std::string> links = {};         ///< where the rows' first cells lead; "" or none = nowhere
};

struct Page {
    std::string title;
    std::vector<std::string> paragraphs;  ///< below the title
    std::vector<PageTable> tables;        ///< above the plots: what was found; small ones stand side by side
    std::vector<Plot> plots;
    std::vector<HeatMap> maps;       ///< below the plots
    std::vector<StackedBars> bars;   ///< below the maps
    std::vector<PageTable> details;  ///< below these
    std::string command;             ///< what made the page
};

/// Every text is escaped.  The same page gives the same bytes.
std::string html_page(const Page& page);

}  // namespace cathlab
