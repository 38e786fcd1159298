#include "autopilot/steering.h"

#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {

namespace {

constexpr double sample_mm = 5.0;
constexpr double first_step_rad = 0.2, last_step_rad = 0.005;
constexpr int most_rounds = 60;

void put(const CatheterSpec& spec, const Bends& bends, CatheterState& state) {
    for (std::size_t k = 0; k < state.bend_rad.size(); ++k) {
        const Vec2 b = bends.wanted[k];
        state.bend_rad[k] = std::min(std::sqrt(b.squaredNorm()), spec.segments[k].max_bend_deg * units::pi / 180.0);
        state.direction_rad[k] = det::atan2(b.y(), b.x());
    }
}

double cost(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, const Way& way,
            const SteeringGoal& goal) {
    const CatheterShape now = shape(spec, state, rail, sample_mm);
    const double base = base_arc_mm(spec, state);
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < now.points.size(); ++i) {
        if (now.arc[i] < base) continue;
        const Way::Place place = way.locate(now.points[i]);
        // The middle of a wide vessel is no better than anywhere well off its wall.
        const double near_wall = place.off_mm / std::max(1.0, place.radius_mm);
        sum += near_wall * near_wall * place.off_mm * place.off_mm;
        ++count;
    }
    return sum / std::max(1, count) + goal.weight * (now.tip.position - goal.tip).squaredNorm();
}

}  // namespace

Bends bends_of(const CatheterState& state) {
    Bends out;
    for (std::size_t k = 0; k < state.bend_rad.size(); ++k)
        out.wanted.push_back(state.bend_rad[k] *
                             Vec2(det::cos(state.direction_rad[k]), det::sin(state.direction_rad[k])));
    return out;
}

Bends steer(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double insertion_mm, const Way& way,
            const SteeringGoal& goal, Bends start) {
    CatheterState trial = state;
    trial.insertion_mm = insertion_mm;
    const auto value = [&](const Bends& bends) {
        put(spec, bends, trial);
        return cost(spec, trial, rail, way, goal);
    };
    double best = value(start), step = first_step_rad;
    for (int round = 0; round < most_rounds && step > last_step_rad; ++round) {
        bool better = false;
        for (std::size_t k = 0; k < start.wanted.size(); ++k)
            for (Index axis = 0; axis < 2; ++axis)
                for (const double way_of : {step, -step}) {
                    Bends other = start;
                    other.wanted[k][axis] += way_of;
                    const double now = value(other);
                    if (now >= best) continue;
                    best = now;
                    start = other;
                    better = true;
                    break;
                }
        if (!better) step *= 0.5;
    }
    return start;
}

}  // namespace cathlab
