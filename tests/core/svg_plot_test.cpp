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

TEST(SvgPlot, CountsHaveWholeTicksAndAnEndShortOfATickReachesIt) {
    const std::string counts = svg_plot(line_plot({5.0, 4.0, 3.0, 2.5, 2.2}));
    EXPECT_NE(counts.find(">3</text>"), std::string::npos);
    EXPECT_EQ(counts.find(">1.5</text>"), std::string::npos);
    Plot beats = line_plot({5.0, 4.0, 3.0});
    beats.curves[0].x = {0.02, 1.5, 2.98};
    const std::string ends = svg_plot(beats);
    EXPECT_NE(ends.find("x=\"74.0\" y=\"326.0\" text-anchor=\"middle\">0</text>"), std::string::npos);
    EXPECT_NE(ends.find("x=\"704.0\" y=\"326.0\" text-anchor=\"middle\">3</text>"), std::string::npos);
}

TEST(SvgPlot, TicksOfNearlyEqualNumbersAreToldApartAndLeaveTheAxisItsName) {
    Plot plot = line_plot({100.001, 100.002, 100.005});
    std::string svg = svg_plot(plot);
    for (const char* tick : {">100.001<", ">100.002<", ">100.005<"}) EXPECT_EQ(count(svg, tick), 1U) << tick;
    plot = line_plot({0.0374999, 0.0374998});
    plot.log_y = true;
    svg = svg_plot(plot);
    const auto tick = svg.find(">0.0374999<");
    ASSERT_NE(tick, std::string::npos);
    const double end = std::stod(svg.substr(svg.rfind("x=\"", tick) + 3));
    EXPECT_GT(end - 7.6 * 9, 22.0);  // the name stands at 16 px and is 12 px high
}

TEST(SvgPlot, ALongNameInTheLegendKeepsItsRoom) {
    const auto place_of = [](const std::string& svg, const std::string& name) {
        const auto at = svg.rfind("x=\"", svg.find(">" + name + "<"));
        return std::stod(svg.substr(at + 3));
    };
    Plot plot = line_plot({1.0, 2.0});
    plot.curves.push_back(plot.curves[0]);
    plot.curves[0].label = "thirty letters and a few over it";
    plot.curves[1].label = "next";
    const std::string svg = svg_plot(plot);
    EXPECT_GT(place_of(svg, "next") - place_of(svg, plot.curves[0].label), 6.5 * 32);
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
    EXPECT_EQ(svg_plot(line_plot({0.1, std::nextafter(0.1, 1.0)})).find("nan"), std::string::npos);
    EXPECT_TRUE(round_ticks(0.1, std::nextafter(0.1, 1.0), 6).empty());
    EXPECT_TRUE(round_ticks(-1e308, 1e308, 6).size() < 20U);
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
                    .maps = {},
                    .bars = {},
                    .details = {{"d", {"", ""}, {{"more", "2"}}}},
                    .command = "cathlab 'a b'"};
    const std::string html = html_page(page);
    EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0U);
    for (const char* never : {"<script", "src=", "href=", "@import", "url("})
        EXPECT_EQ(html.find(never), std::string::npos) << never;
    EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
    EXPECT_NE(html.find("<td>row</td><td>1</td>"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_LT(html.find("<svg"), html.find("<td>more</td>"));
    EXPECT_EQ(html.find("<th></th><th></th>"), std::string::npos);
    EXPECT_EQ(html, html_page(page));
}
