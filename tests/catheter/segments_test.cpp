// Catheters with any number of segments: the chain of frames, rates, ranges, the wall's say.
#include <gtest/gtest.h>

#include <cmath>

#include "catheter/wall_limit.h"
#include "core/random.h"
#include "core/units.h"
#include "straight_rail.h"

namespace cathlab {
namespace {

double draw(std::uint64_t seed, std::uint64_t i) {
    return random_uniform(seed, RandomStream::test, 0, i);
}

CatheterSpec with_segments(std::size_t count) {
    CatheterSpec spec;
    spec.segments.clear();
    for (std::size_t k = 0; k < count; ++k) {
        CatheterSegment segment;
        segment.name = "s" + std::to_string(k);
        segment.length_mm = 8.0 + 3.0 * static_cast<double>(k);
        segment.max_bend_deg = 30.0 + 15.0 * static_cast<double>(k);
        segment.max_rate_deg_s = 20.0 + 10.0 * static_cast<double>(k);
        spec.segments.push_back(segment);
    }
    validate(spec);
    return spec;
}

Eigen::Matrix4d moved(const Mat3& rotation, const Vec3& way) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation;
    m.topRightCorner<3, 1>() = way;
    return m;
}

Mat3 about(const Vec3& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

class Segments : public testing::TestWithParam<std::size_t> {};

TEST_P(Segments, TheTipStandsWhereTheProductOfFramesPutsIt) {
    const CatheterSpec spec = with_segments(GetParam());
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        CatheterState state = initial_state(spec, 250.0);
        state.rotation_rad = 6.0 * draw(seed, 0) - 3.0;
        Eigen::Matrix4d frame = moved(Mat3::Identity(), Vec3(0.0, 0.0, 250.0 - spec.steerable_length_mm()));
        frame = frame * moved(about(Vec3::UnitZ(), state.rotation_rad), Vec3::Zero());
        for (std::size_t k = 0; k < spec.segments.size(); ++k) {
            const double bend = state.bend_rad[k] = draw(seed, 10 + k) * spec.segments[k].max_bend_deg * units::deg;
            const double phi = state.direction_rad[k] = 6.2 * draw(seed, 30 + k) - 3.1;
            const double r = spec.segments[k].length_mm / bend;  // 1 / kappa
            const Mat3 turn = about(Vec3::UnitZ(), phi) * about(Vec3::UnitY(), bend) * about(Vec3::UnitZ(), -phi);
            const Vec3 way(r * (1.0 - std::cos(bend)) * std::cos(phi), r * (1.0 - std::cos(bend)) * std::sin(phi),
                           r * std::sin(bend));
            frame = frame * moved(turn, way);
            const double straight = k + 1 < spec.segments.size() ? spec.link_length_mm : spec.tip_length_mm;
            frame = frame * moved(Mat3::Identity(), Vec3(0.0, 0.0, straight));
        }
        const CatheterShape got = shape(spec, state, straight_rail(400.0));
        EXPECT_LT((got.tip.position - frame.topRightCorner<3, 1>()).norm(), 1e-9) << "seed " << seed;
        EXPECT_LT((got.tip.orientation * Vec3::UnitZ() - frame.block<3, 1>(0, 2)).norm(), 1e-9) << "seed " << seed;
    }
}

TEST_P(Segments, EachKeepsItsOwnRateAndRange) {
    const CatheterSpec spec = with_segments(GetParam());
    const double h = 0.005;
    CatheterState state = initial_state(spec, 250.0);
    CatheterCommand command;
    command.bend_rad.assign(spec.segments.size(), 100.0);
    command.direction_rad.assign(spec.segments.size(), 0.3);
    for (int i = 0; i < 3000; ++i) {
        const CatheterState next = attempt(spec, state, command, 1.0, h);
        for (std::size_t k = 0; k < spec.segments.size(); ++k) {
            const Vec2 was =
                state.bend_rad[k] * Vec2(std::cos(state.direction_rad[k]), std::sin(state.direction_rad[k]));
            const Vec2 is = next.bend_rad[k] * Vec2(std::cos(next.direction_rad[k]), std::sin(next.direction_rad[k]));
            EXPECT_LE((is - was).norm(), spec.segments[k].max_rate_deg_s * units::deg * h * (1.0 + 1e-9));
            EXPECT_LE(next.bend_rad[k], spec.segments[k].max_bend_deg * units::deg * (1.0 + 1e-12));
        }
        state = next;
        if (i == 1500) command.direction_rad.assign(spec.segments.size(), 2.8);
    }
    for (std::size_t k = 0; k < spec.segments.size(); ++k)
        EXPECT_NEAR(state.bend_rad[k], spec.segments[k].max_bend_deg * units::deg, 1e-9);
}

TEST_P(Segments, TheWallTakesItsPartOfEachCommand) {
    // A plane beside the tip: what is taken keeps the tip above its limit, and segments that move away from it move on.
    const CatheterSpec spec = with_segments(GetParam());
    const Rail rail = straight_rail(400.0);
    CatheterState state = initial_state(spec, 250.0);
    CatheterCommand command;
    command.bend_rad.assign(spec.segments.size(), 0.4);
    command.direction_rad.assign(spec.segments.size(), 0.0);  // towards +x, into the plane at x = 3 mm
    for (int i = 0; i < 400; ++i) {
        const CatheterShape now = shape(spec, state, rail);
        std::vector<WallLimit> limits;
        for (std::size_t k = 0; k < now.points.size(); ++k) {
            WallLimit limit;
            limit.point = static_cast<Index>(k);
            limit.normal = -Vec3::UnitX();
            limit.gap = 3.0 - now.points[k].x();
            limit.penetration_limit = 0.2;
            limit.force_limit = 1000.0;
            limits.push_back(limit);
        }
        state = take(spec, state, command, rail, limits, 0.005, 1e9).state;
        for (const Vec3& p : shape(spec, state, rail).points) EXPECT_LT(p.x(), 3.2 + 0.02) << i;
    }
    EXPECT_GT(shape(spec, state, rail).tip.position.x(), 2.5);
}

INSTANTIATE_TEST_SUITE_P(OneToEight, Segments, testing::Values(1, 2, 3, 5, 8));

}  // namespace
}  // namespace cathlab
