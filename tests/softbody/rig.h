// Walls that several tests share.
#pragma once

#include <utility>

#include "core/deterministic_math.h"
#include "core/random.h"
#include "softbody/binding.h"
#include "softbody/model.h"
#include "softbody/observe.h"
#include "softbody/solver.h"
#include "softbody/tube.h"

namespace cathlab::rig {

inline TubeShape shape(double radius, double length, bool closed = true) {
    TubeShape tube;
    tube.radius_mm = radius;
    tube.length_mm = length;
    tube.closed = closed;
    tube.edge_mm = std::min(0.7, radius / 3.0);
    return tube;
}

inline WallSample sample(double radius = 12.0, double length = 60.0, bool closed = true, double spacing = 2.1) {
    return tube_sample(shape(radius, length, closed), spacing, 1.0, 7);
}

inline SoftBodyModel free_tube(const WallParameters& parameters = {}) {
    return build_soft_body(sample(), parameters, nullptr);
}

/// A wall with its state, stepped together.
struct Wall {
    SoftBodyModel model;
    SoftBodyState state;
    SoftBodyScratch scratch;
    Workers workers{1};

    explicit Wall(SoftBodyModel m, int threads = 1) : model(std::move(m)), state(rest_state(model)), workers(threads) {}

    void step(double h, int iterations, std::span<const Vec3> external = {}, std::span<const Vec3> row_force = {}) {
        predict(model, state, scratch, h, external, workers);
        std::copy(row_force.begin(), row_force.end(), scratch.force.begin());
        for (int k = 0; k < iterations; ++k) {
            solve_goals(model, state, scratch, workers);
            apply(model, state, scratch, h, workers);
        }
        finish(model, state, scratch, h, workers);
    }
};

inline Vec3 random_vector(std::uint64_t index, double size) {
    Vec3 v;
    for (int k = 0; k < 3; ++k)
        v[k] = size * (2.0 * random_uniform(1, RandomStream::test, static_cast<std::uint64_t>(k), index) - 1.0);
    return v;
}

/// Gives the wall random velocities.
inline void shake(Wall& wall, double speed) {
    for (std::size_t i = 0; i < wall.model.size(); ++i) wall.state.v[i] = random_vector(i, speed);
}

}  // namespace cathlab::rig
