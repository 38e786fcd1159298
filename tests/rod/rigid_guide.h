// A wire among rigid things: walls that give way by next to nothing, with friction.
#pragma once

#include <functional>
#include <vector>

#include "rod_fixture.h"

namespace cathlab::test {

/// What a rigid wall says to a point of the wire's axis.
struct Touch {
    Vec3 normal = Vec3::UnitX();  ///< unit, away from the wall
    double gap = 1.0;             ///< from the wire's surface to the wall, mm
    Vec3 offset = Vec3::Zero();   ///< of the point that touches, from the sample
    bool bilateral = false;       ///< holds both ways
};
using Walls = std::function<void(const RodSample& sample, std::vector<Touch>& out)>;

/// Steps a wire among walls and keeps the rows of its last solve.
struct GuidedWire {
    explicit GuidedWire(Rod wire) : rod(std::move(wire)) {}
    Rod rod;
    Walls walls;
    double friction = 0.0, compliance = 1e-5, spacing = 0.0;  // spacing 0 = one sample a link, at its centre
    int solves = 3;
    std::vector<ChainRow> rows;
    std::vector<RodSample> at;  // the sample of each row

    void step(double h, double advance = 0.0, double rotate = 0.0, std::span<const Vec3> force = {}) {
        rod.command(advance, rotate);
        std::vector<Pose> start;
        for (std::size_t i = 0; i < rod.link_count(); ++i) start.push_back(rod.link_pose(i));
        rod.predict(h, force);
        std::vector<ChainRow> before;  // forces are kept from solve to solve and from step to step
        for (int k = 0; k < solves; ++k) {
            before.swap(rows);
            rows.clear();
            at.clear();
            std::vector<Touch> touches;
            for (const RodSample& sample : samples()) {
                touches.clear();
                walls(sample, touches);
                for (const Touch& touch : touches) {
                    ChainRow row;
                    const std::size_t n = rows.size();
                    if (n < before.size() && before[n].link == sample.link) row = before[n];
                    if (k == 0) row.held = row.tangent_force;
                    row.link = sample.link;
                    row.normal = touch.normal;
                    row.arm = sample.arm + touch.offset - touch.normal * (touch.bilateral ? 0.0 : sample.radius);
                    row.bilateral = touch.bilateral;
                    row.compliance = compliance;
                    row.gap = touch.gap + compliance * row.multiplier;
                    row.friction = friction;
                    const Pose now = rod.link_pose(static_cast<std::size_t>(sample.link));
                    const Pose& was = start[static_cast<std::size_t>(sample.link)];
                    const Vec3 moved = row.arm + now.position - was.to_world(now.orientation.conjugate() * row.arm);
                    row.slip = moved - row.normal * row.normal.dot(moved) + compliance * (row.tangent_force - row.held);
                    rows.push_back(row);
                    at.push_back(sample);
                }
            }
            rod.solve(h, rows);
        }
        rod.finish(h);
    }

    std::vector<RodSample> samples() const {
        std::vector<RodSample> out;
        if (spacing > 0.0) {
            rod.samples(spacing, out);
        } else {
            for (std::size_t i = 0; i < rod.free_link_count(); ++i)
                out.push_back({static_cast<Index>(i), Vec3::Zero(), rod.link_pose(i).position, rod.link_radius(i)});
        }
        return out;
    }
};

}  // namespace cathlab::test
