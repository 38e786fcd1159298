#include "hud/hud.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cathlab {
namespace {

HudData two_forces(double wire_n, double catheter_n) {
    HudData data;
    data.primary_deg = 30;
    data.kvp = 80;
    data.beam_on = true;
    data.forces = {{"wire", wire_n, 0.8, true}, {"catheter", catheter_n, 0.8, true}};
    data.insertion = "wire 412 mm";
    data.messages = {"limit"};
    return data;
}

// Width of the painted bar: the widest rectangle of this colour whose left edge is the trough's.
float bar_width(const HudDrawList& list, const HudRect& trough, std::uint32_t rgba) {
    float widest = 0;
    for (const DrawVertex& v : list.vertices) {
        if (v.rgba == rgba && v.y >= trough.y0 - 0.5F && v.y <= trough.y1 + 0.5F && v.x <= trough.x1 + 0.5F) {
            widest = std::max(widest, v.x - trough.x0);
        }
    }
    return widest;
}

constexpr std::uint32_t rgb(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
    return r | g << 8 | b << 16 | 0xFF000000U;
}
constexpr std::uint32_t calm = rgb(0, 158, 115), stop = rgb(213, 94, 0);

TEST(ForceBar, ItsLengthIsTheForceOverTheLimit) {
    Hud hud;
    HudLayout layout;
    HudDrawList list;
    const HudRect wire = force_bar_rect(layout, 2, 0);
    for (const double force : {0.08, 0.2, 0.4, 0.5}) {
        hud.draw(two_forces(force, 0), layout, list);
        EXPECT_NEAR(bar_width(list, wire, calm) / (wire.x1 - wire.x0), force / 0.8, 0.005);
    }
}

TEST(ForceBar, IsFullAndInStopColourAtTheLimit) {
    Hud hud;
    HudLayout layout;
    HudDrawList list;
    hud.draw(two_forces(0, 1.9), layout, list);
    const HudRect catheter = force_bar_rect(layout, 2, 1);
    EXPECT_NEAR(bar_width(list, catheter, stop), catheter.x1 - catheter.x0, 0.6);
    EXPECT_EQ(bar_width(list, catheter, calm), 0.0F);
}

TEST(ForceBar, AReadingThatIsNotJudgedNeverTakesTheStopColour) {
    Hud hud;
    HudLayout layout;
    HudDrawList list;
    HudData data = two_forces(0.1, 1.9);
    data.forces[1].judged = false;
    hud.draw(data, layout, list);
    const HudRect catheter = force_bar_rect(layout, 2, 1);
    EXPECT_NEAR(bar_width(list, catheter, calm), catheter.x1 - catheter.x0, 0.6);
    for (const DrawVertex& v : list.vertices) {
        if (v.y > catheter.y0 - 5.0F) {
            EXPECT_NE(v.rgba, stop);
        }
    }
}

TEST(Hud, TheSameDataGiveTheSameTrianglesInsideThePicture) {
    Hud hud, other;
    HudLayout layout;
    HudDrawList a, b;
    hud.draw(two_forces(0.3, 0.1), layout, a);
    other.draw(two_forces(0.9, 0.1), layout, b);
    other.draw(two_forces(0.3, 0.1), layout, b);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (std::size_t i = 0; i < a.vertices.size(); ++i) {
        EXPECT_EQ(a.vertices[i].x, b.vertices[i].x);
        EXPECT_EQ(a.vertices[i].rgba, b.vertices[i].rgba);
        EXPECT_GE(a.vertices[i].x, -1.0F);
        EXPECT_LE(a.vertices[i].x, layout.width + 1);
        EXPECT_GE(a.vertices[i].y, -1.0F);
        EXPECT_LE(a.vertices[i].y, layout.height + 1);
    }
    EXPECT_EQ(a.indices, b.indices);
    ASSERT_FALSE(a.empty());
    std::size_t covered = 0;
    for (const DrawCommand& c : a.commands) covered += c.index_count;
    EXPECT_EQ(covered, a.indices.size());
    EXPECT_GT(a.atlas->alpha.size(), 1000U);
}

TEST(Hud, OtherSizesAndScalesKeepTheBarsApart) {
    for (const float scale : {0.75F, 1.0F, 2.0F}) {
        HudLayout layout{1600, 900, 800, scale};
        const HudRect first = force_bar_rect(layout, 2, 0), second = force_bar_rect(layout, 2, 1);
        EXPECT_LT(first.y1 + 14 * scale, second.y0);
        EXPECT_LT(second.y1, layout.height);
        EXPECT_GT(first.x0, layout.split);
        EXPECT_LT(first.x1, layout.width);
    }
}

TEST(Hud, AnglesAreNamedByDicomsSigns) {
    EXPECT_EQ(primary_text(30.2), "LAO 30");
    EXPECT_EQ(primary_text(-12), "RAO 12");
    EXPECT_EQ(primary_text(0.3), "AP 0");
    EXPECT_EQ(secondary_text(25), "CRAN 25");
    EXPECT_EQ(secondary_text(-30), "CAUD 30");
    EXPECT_EQ(time_text(187.45), "3:07.4");
    EXPECT_EQ(time_text(0.3), "0:00.3");
}

}  // namespace
}  // namespace cathlab
