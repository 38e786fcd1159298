#pragma once

#include <algorithm>
#include <span>

#include "contact/rows.h"

namespace cathlab::test {

inline constexpr double h = 0.004;  ///< substep, s

/// A point mass: the simplest thing that takes rows as a chain does, every row with the mass's compliance h^2/M added.
struct Ball {
    double mass = 1e-4;  // kg
    double radius = 0.5;
    double friction = 0.0;
    Vec3 p = Vec3::Zero(), v = Vec3::Zero(), weight = Vec3::Zero();
    Vec3 before = Vec3::Zero(), predicted = Vec3::Zero();

    void predict() {
        before = p;
        p += h * v + h * h / mass * weight;
        predicted = p;
    }
    DeviceSample sample() const {
        DeviceSample s;
        s.position = p;
        s.radius = radius;
        s.friction = friction;
        s.previous = before;
        return s;
    }
    void solve(std::span<ChainRow> rows) {
        const double own = h * h / mass;
        Vec3 force = Vec3::Zero();  // with what the rows remember
        for (const ChainRow& row : rows) force += row.multiplier * row.normal + row.tangent_force;
        const auto shift = [&](const Vec3& by, double yielding, const ChainRow* only) {
            for (ChainRow& row : rows) {
                const Vec3 apart = by + (&row == only ? yielding : 0.0) / own * by;
                row.gap += row.normal.dot(apart);
                row.slip += apart - row.normal.dot(apart) * row.normal;
            }
            p += by;
        };
        shift(predicted + own * force - p, 0.0, nullptr);
        for (int sweep = 0; sweep < 10; ++sweep) {
            for (ChainRow& row : rows) {
                const Vec3 old = row.multiplier * row.normal + row.tangent_force;
                const double both = own + row.compliance;
                row.multiplier = std::max(0.0, row.multiplier - row.gap / both);
                Vec3 t = row.tangent_force - row.slip / both;
                const double limit = row.friction * row.multiplier;
                if (t.norm() > limit) t *= limit / t.norm();
                row.tangent_force = t;
                shift(own * (row.multiplier * row.normal + t - old), row.compliance, &row);
            }
        }
    }
    void finish() { v = (p - before) / h; }
};

}  // namespace cathlab::test
