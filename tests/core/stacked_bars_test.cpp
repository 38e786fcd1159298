// Bars of shares: each row fills its width, whatever its count.
#include "core/stacked_bars.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace cathlab {
namespace {

TEST(StackedBars, ARowIsFilledByItsShares) {
    StackedBars bars;
    bars.title = "a & b";
    bars.parts = {"1", "2"};
    bars.rows = {{"x", {1, 3}}, {"none", {0, 0}}};
    const std::string svg = svg_stacked_bars(bars);
    EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
    EXPECT_NE(svg.find("width=\"90.0\""), std::string::npos);   // a quarter of 360
    EXPECT_NE(svg.find("width=\"270.0\""), std::string::npos);  // three
    EXPECT_NE(svg.find(">none</text>"), std::string::npos);
    bars.rows[0].counts.pop_back();
    EXPECT_THROW(svg_stacked_bars(bars), std::logic_error);
}

TEST(StackedBars, ALongLabelIsCutAtABlank) {
    StackedBars bars;
    bars.parts = {"1"};
    bars.rows = {{std::string(40, 'a') + " " + std::string(40, 'b'), {1}}};
    const std::string svg = svg_stacked_bars(bars);
    EXPECT_NE(svg.find(">" + std::string(40, 'a') + "</text>"), std::string::npos);
    EXPECT_NE(svg.find(">" + std::string(40, 'b') + "</text>"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
