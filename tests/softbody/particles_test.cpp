// The walks over particles, at both widths, against the equations of solver.h written out one particle at a time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "softbody/kernel.h"
#include "softbody/rig.h"

namespace cathlab {
namespace {

constexpr std::size_t count = 23;  // no multiple of any width
constexpr double h = 0.004;

/// A wall of particles that have everything a model can have.
struct Cloud {
    std::vector<double> mass, stiffness, scale, support, drag;
    std::vector<std::uint8_t> fixed;
    std::vector<Vec3> rest, before, after, x, v, start, predicted, force, goal, last_goal;
    std::vector<double> compliance;
    double farthest = 1e9;

    Cloud() {
        const auto vectors = [](std::uint64_t from, double size) {
            std::vector<Vec3> out(count);
            for (std::size_t i = 0; i < count; ++i) out[i] = rig::random_vector(from + i, size);
            return out;
        };
        rest = vectors(100, 50.0);
        before = vectors(200, 2.0);
        after = vectors(300, 2.0);
        x = vectors(400, 50.0);
        v = vectors(500, 80.0);
        start = predicted = force = x;
        goal = vectors(600, 50.0);
        last_goal = vectors(700, 50.0);
        compliance.assign(count, 0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const double n = static_cast<double>(i);
            mass.push_back(4e-6 + 1e-7 * n);
            stiffness.push_back(70.0 - n);
            scale.push_back(1.0 + 0.1 * n);
            support.push_back(0.02 + 0.001 * n);
            drag.push_back(0.002 + 0.0001 * n);
            fixed.push_back(i % 5 == 3 ? 1 : 0);
        }
    }
    kernel::Particles view() {
        const auto numbers = [](std::vector<Vec3>& of) { return of.front().data(); };
        return {.mass = mass.data(),
                .stiffness = stiffness.data(),
                .stiffness_scale = scale.data(),
                .support = support.data(),
                .drag = drag.data(),
                .rest = numbers(rest),
                .fixed = fixed.data(),
                .support_before = numbers(before),
                .support_after = numbers(after),
                .x = numbers(x),
                .v = numbers(v),
                .start = numbers(start),
                .predicted = numbers(predicted),
                .force = numbers(force),
                .compliance = compliance.data(),
                .goal = numbers(goal),
                .last_goal = numbers(last_goal),
                .h = h,
                .support_share = 0.3,
                .farthest = farthest,
                .towards_goal = 0.02};
    }
};

std::vector<const kernel::Set*> sets() {
    std::vector<const kernel::Set*> out{&kernel::baseline()};
    if (kernel::avx2() != nullptr) out.push_back(kernel::avx2());
    return out;
}

TEST(Particles, ArePredictedByInertiaAndWhatHoldsThem) {
    const Cloud old;
    for (const kernel::Set* set : sets()) {
        Cloud now = old;
        set->predict(now.view(), 0, count);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 stand = old.rest[i] + 0.7 * old.before[i] + 0.3 * old.after[i];
            const double inertia = old.mass[i] / h / h;
            ASSERT_EQ(now.start[i], old.x[i]);
            ASSERT_EQ(now.force[i], Vec3(0, 0, 0));
            if (old.fixed[i]) {
                ASSERT_LT((now.x[i] - stand).norm(), 1e-12) << set->name << " " << i;
                ASSERT_EQ(now.predicted[i], now.x[i]);
                ASSERT_EQ(now.compliance[i], 0.0);
                continue;
            }
            const Vec3 coasted = old.x[i] + h * old.v[i];
            const Vec3 pulled = coasted + (old.support[i] * stand + old.drag[i] / h * old.x[i]) / inertia;
            const double stiff = inertia + old.support[i] + old.drag[i] / h + old.scale[i] * old.stiffness[i];
            ASSERT_LT((now.x[i] - coasted).norm(), 1e-12) << set->name << " " << i;
            ASSERT_LT((now.predicted[i] - pulled).norm(), 1e-9) << set->name << " " << i;
            ASSERT_NEAR(now.compliance[i] * stiff, 1.0, 1e-12);
        }
    }
}

TEST(Particles, StandBetweenInertiaGoalAndForce) {
    Cloud old;
    kernel::baseline().predict(old.view(), 0, count);
    for (std::size_t i = 0; i < count; ++i) old.force[i] = rig::random_vector(800 + i, 30.0);
    for (const double farthest : {1e9, 5.0}) {
        old.farthest = farthest;
        for (const kernel::Set* set : sets()) {
            Cloud now = old;
            set->apply(now.view(), 0, count);
            bool limited = false;
            for (std::size_t i = 0; i < count; ++i) {
                if (old.fixed[i]) {
                    ASSERT_EQ(now.x[i], old.x[i]);
                    continue;
                }
                const double stiff = old.scale[i] * old.stiffness[i];
                Vec3 to =
                    old.compliance[i] * (old.mass[i] / h / h * old.predicted[i] + stiff * old.goal[i] + old.force[i]);
                const Vec3 way = to - old.start[i];
                if (way.norm() > farthest) {
                    to = old.start[i] + way * (farthest / way.norm());
                    limited = true;
                }
                ASSERT_LT((now.x[i] - to).norm(), 1e-10) << set->name << " " << i;
            }
            ASSERT_EQ(limited, farthest < 1e9);
        }
    }
}

TEST(Particles, EndWithTheVelocityOfTheirWayDrawnToTheirGoals) {
    const Cloud old;
    for (const kernel::Set* set : sets()) {
        Cloud now = old;
        for (std::size_t i = 0; i < count; ++i) now.start[i] = old.x[i] - rig::random_vector(900 + i, 1.0);
        set->finish(now.view(), 0, count);
        for (std::size_t i = 0; i < count; ++i) {
            Vec3 v = (old.x[i] - now.start[i]) / h;
            if (!old.fixed[i]) v += 0.02 * ((old.goal[i] - old.last_goal[i]) / h - v);
            ASSERT_LT((now.v[i] - v).norm(), 1e-8) << set->name << " " << i;
        }
    }
}

TEST(Particles, AreTheSameBitsAtAnyWidthAndInAnyPieces) {
    Cloud whole, pieces;
    whole.farthest = pieces.farthest = 5.0;
    const auto run = [](Cloud& cloud, const kernel::Set& set, const std::vector<std::size_t>& cuts) {
        const auto walk = [&](kernel::Walk what) {
            for (std::size_t k = 0; k + 1 < cuts.size(); ++k) what(cloud.view(), cuts[k], cuts[k + 1]);
        };
        walk(set.predict);
        walk(set.apply);
        walk(set.finish);
    };
    run(whole, kernel::baseline(), {0, count});
    run(pieces, *sets().back(), {0, 1, 6, 6, 14, count});
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(whole.x[i], pieces.x[i]);
        ASSERT_EQ(whole.v[i], pieces.v[i]);
        ASSERT_EQ(whole.predicted[i], pieces.predicted[i]);
        ASSERT_EQ(whole.compliance[i], pieces.compliance[i]);
    }
}

}  // namespace
}  // namespace cathlab
