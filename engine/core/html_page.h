// A report as one HTML page that holds everything it shows: no script, nothing from elsewhere, ready for the printer.
#pragma once

#include <string>
#include <vector>

#include "core/svg_plot.h"

namespace cathlab {

struct PageTable {
    std::string caption;
    std::vector<std::string> header;             ///< one a column
    std::vector<std::vector<std::string>> rows;  ///< the first cell of a row names it
};

struct Page {
    std::string title;
    std::vector<std::string> paragraphs;  ///< below the title
    std::vector<PageTable> tables;
    std::vector<Plot> plots;
    std::string command;  ///< what made the page
};

/// Every text is escaped.  The same page gives the same bytes.
std::string html_page(const Page& page);

}  // namespace cathlab
