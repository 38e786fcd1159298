#include "core/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/html_page.h"

using namespace cathlab;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

Plot line_plot(std::vector<double> y) {
    Plot plot{.title = "a < b", .x_label = "x, mm", .y_label = "y & z", .curves = {}};
    std::vector<double> x;
    for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i));
    plot.curves.push_back({.label = "it's", .x = x, .y = std::move(y), .marks = true});
    return plot;
}

}  // namespace

TEST(SvgPlot, TicksAreRoundAndWithinTheirRange) {
    EXPECT_EQ(round_ticks(0.0, 10.0, 5), (std::vector{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
    const std::vector<double> ticks = round_ticks(-0.013, 0.021, 6);
    ASSERT_GE(ticks.size(), 3U);
    for (const double t : ticks) EXPECT_TRUE(t >= -0.0131 && t <= 0.0211);
    EXPECT_TRUE(round_ticks(1.0, 1.0, 5).empty());
    EXPECT_TRUE(round_ticks(0.0, INFINITY, 5).empty());
}

TEST(SvgPlot, NumbersAreShort) {
    EXPECT_EQ(plain_number(0.25), "0.25");
    EXPECT_EQ(plain_number(580.0), "580");
    EXPECT_EQ(plain_number(123456.0), "123456");
    EXPECT_EQ(plain_number(-0.0), "0");
    EXPECT_EQ(plain_number(0.123456, 3), "0.123");
    EXPECT_EQ(plain_number(1.5e-7), "1.5e-07");
    EXPECT_EQ(plain_number(std::nan("")), "none");
}

TEST(SvgPlot, EveryTextIsEscapedAndEveryPointMarked) {
    const std::string svg = svg_plot(line_plot({1.0, 2.0, 4.0}));
    EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
    EXPECT_NE(svg.find("y &amp; z"), std::string::npos);
    EXPECT_NE(svg.find("it&#39;s"), std::string::npos);
    EXPECT_EQ(svg.find("a < b"), std::string::npos);
    EXPECT_EQ(count(svg, "<path d=\"M"), 1U + 3U + 1U);  // the line, three marks, the legend's mark
    EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
}

TEST(SvgPlot, WhatIsNotFiniteInterruptsTheLine) {
    Plot plot = line_plot({1.0, 2.0, std::nan(""), 4.0, INFINITY, 5.0});
    plot.curves[0].marks = false;
    const std::string svg = svg_plot(plot);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    const auto line = svg.find("<path d=\"M");
    const std::string path = svg.substr(line, svg.find("\" fill", line) - line);
    EXPECT_EQ(count(path, "M"), 3U);
    EXPECT_EQ(count(path, "L"), 1U);
}

TEST(SvgPlot, NothingOneValueAndLogarithmsAreDrawnToo) {
    EXPECT_NE(svg_plot(Plot{}).find("no points"), std::string::npos);
    EXPECT_NE(svg_plot(line_plot({std::nan("")})).find("no points"), std::string::npos);
    EXPECT_EQ(svg_plot(line_plot({3.0, 3.0})).find("nan"), std::string::npos);
    EXPECT_EQ(svg_plot(line_plot({0.0})).find("nan"), std::string::npos);
    Plot logarithmic = line_plot({100.0, 1.0, 0.0, -1.0, 0.01});
    logarithmic.log_y = true;
    const std::string svg = svg_plot(logarithmic);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(svg.find(">100<"), std::string::npos);
    Plot odd = line_plot({1.0});
    odd.curves[0].x.clear();
    EXPECT_THROW(svg_plot(odd), std::logic_error);
}

TEST(HtmlPage, HoldsEverythingAndAsksForNothing) {
    const Page page{.title = "<script>",
                    .paragraphs = {"p & q"},
                    .tables = {{"t", {"", "a"}, {{"row", "1"}}}},
                    .plots = {line_plot({1.0, 2.0})},
                    .command = "cathlab 'a b'"};
    const std::string html = html_page(page);
    EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0U);
    for (const char* never : {"<script", "src=", "href=", "@import", "url("})
        EXPECT_EQ(html.find(never), std::string::npos) << never;
    EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
    EXPECT_NE(html.find("<td>row</td><td>1</td>"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_EQ(html, html_page(page));
}
