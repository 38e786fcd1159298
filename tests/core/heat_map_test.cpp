// A heat map draws one cell for each value above zero, darkest where it is most.
#include "core/heat_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace cathlab {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

TEST(HeatMap, DrawsACellForEachValueAboveZeroAndTheLargestIsTheDarkest) {
    HeatMap map;
    map.title = "a < b";
    map.columns = 3;
    map.rows = 2;
    map.values = {0.0, 1.0, 2.0, std::numeric_limits<double>::quiet_NaN(), -1.0, 4.0};
    const std::string svg = svg_heat_map(map);
    EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
    constexpr std::size_t scale = 32;
    EXPECT_EQ(count(svg, "fill=\"rgb("), 3U + scale);
    EXPECT_EQ(count(svg, "rgb(90,12,12)"), 1U);
    map.most = 8.0;  // of another map
    EXPECT_EQ(count(svg_heat_map(map), "rgb(90,12,12)"), 0U);
}

TEST(HeatMap, WithoutAValueItSaysSo) {
    HeatMap map;
    map.columns = map.rows = 1;
    map.values = {0.0};
    EXPECT_NE(svg_heat_map(map).find("nothing to show"), std::string::npos);
    map.values = {};
    EXPECT_THROW(svg_heat_map(map), std::logic_error);
}

}  // namespace
}  // namespace cathlab
