#include "core/html_page.h"

#include <algorithm>

namespace cathlab {
namespace {

constexpr const char* style = R"css(
body { font: 15px/1.45 sans-serif; color: #202020; background: #ffffff; max-width: 760px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.4em; }
svg { max-width: 100%; height: auto; margin: 0.6em 0; }
table { display: inline-table; vertical-align: top; border-collapse: collapse; margin: 1em 2em 1em 0; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3em; }
th, td { border-bottom: 1px solid #c0c0c0; padding: 0.2em 1em 0.2em 0; text-align: right; font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; }
pre { background: #f2f2f2; padding: 0.6em; white-space: pre-wrap; overflow-wrap: anywhere; }
@media print { body { margin: 0; max-width: none; } svg, table { break-inside: avoid; } }
)css";

std::string table_text(const PageTable& table) {
    std::string out = "<table>\n<caption>" + xml_escaped(table.caption) + "</caption>\n";
    const bool headed =
        std::any_of(table.header.begin(), table.header.end(), [](const std::string& cell) { return !cell.empty(); });
    if (headed) {
        out += "<tr>";
        for (const std::string& cell : table.header) out += "<th>" + xml_escaped(cell) + "</th>";
        out += "</tr>\n";
    }
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        out += "<tr>";
        const std::string link = r < table.links.size() ? table.links[r] : "";
        for (std::size_t c = 0; c < table.rows[r].size(); ++c) {
            const std::string cell = xml_escaped(table.rows[r][c]);
            out += "<td>" +
                   (c == 0 && !link.empty() ? "<a href=\"" + xml_escaped(link) + "\">" + cell + "</a>" : cell) +
                   "</td>";
        }
        out += "</tr>\n";
    }
    return out + "</table>\n";
}

}  // namespace

std::string html_page(const Page& page) {
    std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
                      xml_escaped(page.title) + "</title>\n<style>" + style + "</style>\n</head>\n<body>\n<h1>" +
                      xml_escaped(page.title) + "</h1>\n";
    for (const std::string& paragraph : page.paragraphs) out += "<p>" + xml_escaped(paragraph) + "</p>\n";
    for (const PageTable& table : page.tables) out += table_text(table);
    for (const Plot& plot : page.plots) out += svg_plot(plot);
    for (const HeatMap& map : page.maps) out += svg_heat_map(map);
    for (const StackedBars& bars : page.bars) out += svg_stacked_bars(bars);
    for (const PageTable& table : page.details) out += table_text(table);
    if (!page.command.empty()) out += "<p>Made by</p>\n<pre>" + xml_escaped(page.command) + "</pre>\n";
    return out + "</body>\n</html>\n";
}

}  // namespace cathlab
