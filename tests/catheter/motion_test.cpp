#include "catheter/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash.h"
#include "core/units.h"

using namespace cathlab;

namespace {
CatheterCommand bend_to(double proximal, double distal, double direction) {
    CatheterCommand command;
    command.bend_rad = {proximal, distal};
    command.direction_rad = {direction, direction};
    return command;
}
}  // namespace

TEST(CatheterMotion, RatesAndRangesHold) {
    const CatheterSpec spec;
    CatheterState state = initial_state(spec, 100.0);
    CatheterCommand command = bend_to(10.0, 10.0, 0.0);
    command.advance_mm = 50.0;
    command.rotate_rad = -20.0;
    const double h = 0.004;
    state = attempt(spec, state, command, 1.0, h);
    EXPECT_NEAR(state.insertion_mm, 100.4, 1e-12);
    EXPECT_NEAR(state.rotation_rad, -360.0 * units::deg * h, 1e-12);
    EXPECT_NEAR(state.bend_rad[1], 140.0 * units::deg * h, 1e-12);
    for (int i = 0; i < 2000; ++i) state = attempt(spec, state, command, 1.0, h);
    EXPECT_NEAR(state.bend_rad[0], 60.0 * units::deg, 1e-12);
    EXPECT_NEAR(state.bend_rad[1], 140.0 * units::deg, 1e-12);
    EXPECT_NEAR(state.insertion_mm, 100.4 + 800.0, 1e-6);
    for (int i = 0; i < 500; ++i) state = attempt(spec, state, command, 1.0, h);
    EXPECT_DOUBLE_EQ(state.insertion_mm, spec.length_mm);
}

TEST(CatheterMotion, AFractionIsThatPartOfTheMotion) {
    const CatheterSpec spec;
    const CatheterState state = initial_state(spec, 100.0);
    CatheterCommand command = bend_to(0.3, 0.4, 0.5);
    command.advance_mm = 0.2;
    const CatheterState none = attempt(spec, state, command, 0.0, 0.004);
    EXPECT_EQ(none.insertion_mm, state.insertion_mm);
    EXPECT_EQ(none.bend_rad, state.bend_rad);
    const CatheterState half = attempt(spec, state, command, 0.5, 0.004);
    EXPECT_NEAR(half.insertion_mm, 100.1, 1e-12);
    EXPECT_NEAR(half.bend_rad[1], 0.5 * 140.0 * units::deg * 0.004, 1e-12);
}

TEST(CatheterMotion, TheBendTurnsTheShortestWayAndAStraightSegmentStartsAnywhere) {
    const CatheterSpec spec;
    CatheterState state = initial_state(spec, 100.0);
    for (int i = 0; i < 500; ++i) state = attempt(spec, state, bend_to(0.0, 0.5, 170.0 * units::deg), 1.0, 0.004);
    EXPECT_NEAR(state.direction_rad[1], 170.0 * units::deg, 1e-12);
    // To -170 degrees it is 20 degrees across, not 340 back.
    double swept = 0.0, before = state.direction_rad[1];
    for (int i = 0; i < 500; ++i) {
        state = attempt(spec, state, bend_to(0.0, 0.5, -170.0 * units::deg), 1.0, 0.004);
        double change = state.direction_rad[1] - before;
        if (change < -units::pi) change += 2.0 * units::pi;
        swept += change;
        before = state.direction_rad[1];
        EXPECT_GT(state.bend_rad[1], 0.5 * std::cos(10.0 * units::deg) - 1e-9);
    }
    EXPECT_NEAR(swept, 20.0 * units::deg, 1e-9);
}

TEST(CatheterMotion, ACommandThatIsMetMovesNothing) {
    const CatheterSpec spec;
    CatheterState state = initial_state(spec, 100.0);
    const CatheterCommand command = bend_to(0.2, 1.3, 0.7);
    for (int i = 0; i < 1000; ++i) state = attempt(spec, state, command, 1.0, 0.004);
    const CatheterState again = attempt(spec, state, command, 1.0, 0.004);
    EXPECT_EQ(state.bend_rad, again.bend_rad);
    EXPECT_EQ(state.direction_rad, again.direction_rad);
}

TEST(CatheterMotion, NonsenseAndTheGraphsEndAreClamped) {
    const CatheterSpec spec;
    const CatheterState state = initial_state(spec, 100.0);
    CatheterCommand command = bend_to(std::nan(""), INFINITY, 0.0);
    command.advance_mm = std::nan("");
    command.rotate_rad = INFINITY;
    const CatheterState next = attempt(spec, state, command, 1.0, 0.004);
    EXPECT_EQ(next.insertion_mm, 100.0);
    EXPECT_EQ(next.rotation_rad, 0.0);
    EXPECT_EQ(next.bend_rad[0], 0.0);
    command = {};
    command.advance_mm = 0.3;
    EXPECT_DOUBLE_EQ(attempt(spec, state, command, 1.0, 0.004, 100.1).insertion_mm, 100.1);
    EXPECT_DOUBLE_EQ(attempt(spec, state, command, 1.0, 0.004, 90.0).insertion_mm, 100.0);
    command.advance_mm = -0.3;
    EXPECT_DOUBLE_EQ(attempt(spec, state, command, 1.0, 0.004, 90.0).insertion_mm, 99.7);
}

TEST(CatheterMotion, TheHashSeesEveryField) {
    const CatheterSpec spec;
    const auto hash = [](CatheterState s) {
        HashArchive archive;
        visit(archive, s);
        return archive.value();
    };
    const CatheterState state = initial_state(spec, 1.0);
    CatheterState other = state;
    other.route = {1, 2};
    EXPECT_NE(hash(state), hash(other));
    other = state;
    other.direction_rad[1] = 1e-9;
    EXPECT_NE(hash(state), hash(other));
}
