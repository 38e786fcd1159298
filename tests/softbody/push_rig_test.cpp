// A ball against a wall: forces balance, a stiff bed follows Hertz' geometry, the shape of the answer is that of a
// shell.
#include "softbody/push_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.h"
#include "softbody/held_tube.h"
#include "softbody/shell_statics.h"

namespace cathlab {
namespace {

/// In steps of 0.5 mm from just touching along +x at mid-length.
Push outward(double depth) {
    Push push;
    for (double d = 0.0; d <= depth + 1e-9; d += 0.5) push.ball_mm.emplace_back(12.0 - 2.5 + d, 0.0, 30.0);
    push.marker_mm = Vec3(13.5, 0.0, 30.0);
    return push;
}

TEST(PushRig, TheWallGoesWhereTheBallGoesAndPushesBackHarderTheFurther) {
    const PushedWall wall(held_tube(60.0));
    const PushResult result = wall.push(outward(2.0));
    ASSERT_TRUE(result.at_rest);
    EXPECT_NEAR(result.force_mn.front(), 0.0, 5.0);
    for (std::size_t k = 1; k < result.force_mn.size(); ++k) {
        EXPECT_GT(result.force_mn[k], result.force_mn[k - 1]);
        // The marker sits opposite the ball: it rises as far, less what the ball sinks in.
        EXPECT_NEAR(result.marker_mm[k].x() - 13.5, 0.5 * static_cast<double>(k),
                    std::min(0.12, 0.1 * static_cast<double>(k)))
            << k;
    }
}

TEST(PushRig, ForceIsProportionalToTheModulus) {
    PushRig rig = held_tube(60.0);
    const double soft = PushedWall(rig).push(outward(1.0)).force_mn.back();
    rig.young_kpa *= 2.0;
    const double stiff = PushedWall(rig).push(outward(1.0)).force_mn.back();
    EXPECT_NEAR(stiff / soft, 2.0, 1e-3);
}

TEST(PushRig, TheWallIsAsLongOnSparseParticlesAsOnDenseOnes) {
    // Particles of a last row that were held where they lie would be a wall shorter by a spacing, a seventh here.
    const auto force = [](double spacing, double far_spacing) {
        PushRig rig = held_tube(60.0);
        rig.particle_spacing_mm = spacing;
        rig.far_spacing_mm = far_spacing;
        rig.looked_at = outward(4.0).ball_mm;
        return PushedWall(rig).push(outward(4.0)).force_mn.back();
    };
    const double dense = force(1.5, 3.5);
    EXPECT_NEAR(force(2.5, 6.0) / dense, 1.0, 0.08);
    EXPECT_NEAR(force(2.5, 9.0) / dense, 1.0, 0.08);
}

TEST(PushRig, UnloadingIsLoadingOnceMore) {
    const PushedWall wall(held_tube(60.0));
    Push push = outward(1.0);
    push.ball_mm.push_back(push.ball_mm[1]);
    const PushResult result = wall.push(push);
    EXPECT_EQ(result.force_mn.back(), result.force_mn[1]);
    EXPECT_EQ(result.marker_mm.back(), result.marker_mm[1]);
}

PushedLaw elastic_law(double times) {
    PushedLaw law;
    law.membrane = [times](const MembraneMaterial& material, MembranePoint& point) {
        ask_elastic_law({times * material.mu_kpa, material.thinning, material.round}, {}, point);
    };
    return law;
}

void expect_same(const PushResult& a, const PushResult& b) {
    ASSERT_TRUE(a.at_rest);
    ASSERT_TRUE(b.at_rest);
    for (std::size_t k = 0; k < a.force_mn.size(); ++k) {
        EXPECT_LT((a.marker_mm[k] - b.marker_mm[k]).norm(), 1e-3) << k;
        EXPECT_NEAR(a.force_mn[k], b.force_mn[k], 0.5) << k;
    }
}

TEST(PushRig, TheElasticLawAskedAsEffectsAreIsTheWallsOwn) {
    const PushedWall wall(held_tube(60.0));
    expect_same(wall.push(outward(2.0)), wall.push(outward(2.0), elastic_law(1.0)));
}

TEST(PushRig, WhatASearchLeftShortensTheNextAndChangesNothing) {
    const PushedWall wall(held_tube(60.0));
    Push first = outward(2.0);
    first.keep_wall = true;
    std::vector<std::shared_ptr<ShellFactors>> factors(first.ball_mm.size());
    first.factors = factors;
    const PushResult known = wall.push(first, elastic_law(1.0));
    Push second = outward(2.0);
    second.guess = known.wall_mm;
    second.factors = factors;
    expect_same(wall.push(outward(2.0), elastic_law(1.2)), wall.push(second, elastic_law(1.2)));
}

TEST(PushRig, TissueRoundTheWallPushesBackTheHarderTheStifferItIs) {
    const PushedWall wall(held_tube(60.0));
    PushedLaw law;
    double last = wall.push(outward(2.0)).force_mn.back();
    for (const double support : {0.5, 2.0, 8.0, 32.0}) {
        law.support_kpa_per_mm = support;
        const PushResult result = wall.push(outward(2.0), law);
        ASSERT_TRUE(result.at_rest);
        EXPECT_GT(result.force_mn.back(), last) << support;
        last = result.force_mn.back();
    }
}

TEST(PushRig, WhatHoldsTheWallStandsWhereItsLawSaysHoweverFarItGives) {
    const PushedWall wall(held_tube(60.0));
    Push push = outward(2.0);
    push.ball_mm.insert(push.ball_mm.begin(), Vec3(9.0, 0.0, 30.0));  // touches nothing
    push.keep_wall = true;
    double last = wall.push(push).force_mn.back();
    for (const double mm_per_kpa : {0.002, 0.02, 0.2}) {
        std::map<std::size_t, Vec3> pull;
        PushedLaw law;
        law.slip = [=](std::size_t, const Vec3& traction) { return Vec3(mm_per_kpa * traction); };
        law.remember_slip = [&](std::size_t i, const Vec3& traction) { pull[i] = traction; };
        const PushResult result = wall.push(push, law);
        ASSERT_TRUE(result.at_rest);
        ASSERT_FALSE(pull.empty());
        double farthest = 0.0;
        for (const auto& [i, traction] : pull) {
            const Vec3 slipped = result.wall_mm.back()[i] - result.wall_mm.front()[i];
            EXPECT_LT((slipped - mm_per_kpa * traction).norm(), 2e-3) << mm_per_kpa;
            farthest = std::max(farthest, slipped.norm());
        }
        EXPECT_GT(farthest, 0.02) << mm_per_kpa;
        EXPECT_LT(result.force_mn.back(), last) << mm_per_kpa;
        last = result.force_mn.back();
    }
}

TEST(PushRig, ABallPressedFarIntoAFirmlyHeldWallDoesNotComeOutBehindIt) {
    PushRig rig = held_tube(60.0);
    rig.particle_spacing_mm = 2.5;
    PushedLaw firm;
    firm.support_kpa_per_mm = 2.0;
    const PushResult result = PushedWall(rig).push(outward(8.0), firm);
    ASSERT_TRUE(result.at_rest);
    for (std::size_t k = 1; k < result.force_mn.size(); ++k)
        EXPECT_GT(result.force_mn[k], result.force_mn[k - 1]) << 0.5 * static_cast<double>(k) << " mm";
}

TEST(PushRig, WhatIsHeldNowhereOrHasNoSizeIsTold) {
    PushRig rig = held_tube(60.0);
    rig.held.clear();
    EXPECT_THROW(PushedWall{rig}, UserError);
    rig = held_tube(60.0);
    rig.thickness_mm = 0.0;
    EXPECT_THROW(PushedWall{rig}, UserError);
    rig = held_tube(60.0);
    rig.lumen = {};
    EXPECT_THROW(PushedWall{rig}, UserError);
    rig = held_tube(60.0);
    rig.young_kpa = -1.0;
    EXPECT_THROW(PushedWall{rig}, UserError);
}

TEST(PushRig, APushThatIsStoppedSaysSo) {
    const PushedWall wall(held_tube(60.0));
    const PushResult result = wall.push(outward(1.0), [] { return false; });
    EXPECT_FALSE(result.at_rest);
    EXPECT_TRUE(std::isnan(result.force_mn.back()));
}

}  // namespace
}  // namespace cathlab
