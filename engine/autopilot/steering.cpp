#include "autopilot/steering.h"

#include <cmath>
#include <limits>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {

namespace {

constexpr double sample_mm = 5.0;
constexpr double first_step_rad = 0.2, last_step_rad = 0.005;
constexpr int most_rounds = 60;
constexpr double lane_beyond_mm = 40.0;  // of the steerable part, of the way that a plan looks at
constexpr double room_weight = 100.0;    // of a missing mm, squared, at one sample
constexpr double clearly_better = 0.95;  // of the cost, to go where one is not

void put(const CatheterSpec& spec, const Bends& bends, CatheterState& state) {
    for (std::size_t k = 0; k < state.bend_rad.size(); ++k) {
        const Vec2 b = bends.wanted[k];
        state.bend_rad[k] = std::min(std::sqrt(b.squaredNorm()), spec.segments[k].max_bend_deg * units::pi / 180.0);
        state.direction_rad[k] = det::atan2(b.y(), b.x());
    }
}

// What a plan for the steerable part looks at: the way round it.
std::vector<CentrelineNode> lane_round(const Way& way, const Vec3& tip, const CatheterSpec& spec, const Vec3& off) {
    const double arc = way.locate(tip).arc_mm, reach = spec.steerable_length_mm() + lane_beyond_mm;
    std::vector<CentrelineNode> lane = way.between(arc - reach, arc + reach);
    for (CentrelineNode& node : lane) node.position += off;
    return lane;
}

double cost(const CatheterSpec& spec, const CatheterState& state, const Rail& rail,
            const std::vector<CentrelineNode>& lane, const SteeringGoal& goal) {
    const CatheterShape now = shape(spec, state, rail, sample_mm);
    const double base = base_arc_mm(spec, state);
    double middle = 0.0, tight = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < now.points.size(); ++i) {
        if (now.arc[i] < base) continue;
        double to_wall = std::numeric_limits<double>::infinity(), off = 0.0, radius = 0.0;
        for (const CentrelineNode& node : lane) {
            const double d = std::sqrt((now.points[i] - node.position).squaredNorm());
            if (d - node.radius >= to_wall) continue;
            to_wall = d - node.radius;
            off = d;
            radius = node.radius;
        }
        // The middle of a wide vessel is no better than anywhere well off its wall.
        const double near_wall = off / std::max(1.0, radius);
        middle += near_wall * near_wall * off * off;
        const double lacking = std::max(0.0, goal.room_mm + spec.radius_mm() + to_wall);
        tight += lacking * lacking;
        ++count;
    }
    return middle / std::max(1, count) + room_weight * tight +
           goal.weight * (now.tip.position - goal.tip).squaredNorm();
}

}  // namespace

Bends bends_of(const CatheterState& state) {
    Bends out;
    for (std::size_t k = 0; k < state.bend_rad.size(); ++k)
        out.wanted.push_back(state.bend_rad[k] *
                             Vec2(det::cos(state.direction_rad[k]), det::sin(state.direction_rad[k])));
    return out;
}

namespace {

Bends search(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double insertion_mm,
             const std::vector<CentrelineNode>& lane, const SteeringGoal& goal, Bends start) {
    CatheterState trial = state;
    trial.insertion_mm = insertion_mm;
    const auto value = [&](const Bends& bends) {
        put(spec, bends, trial);
        return cost(spec, trial, rail, lane, goal);
    };
    start.cost = value(start);
    double step = first_step_rad;
    for (int round = 0; round < most_rounds && step > last_step_rad; ++round) {
        bool better = false;
        for (std::size_t k = 0; k < start.wanted.size(); ++k)
            for (Index axis = 0; axis < 2; ++axis)
                for (const double way_of : {step, -step}) {
                    Bends other = start;
                    other.wanted[k][axis] += way_of;
                    other.cost = value(other);
                    if (other.cost >= start.cost) continue;
                    start = other;
                    better = true;
                    break;
                }
        if (!better) step *= 0.5;
    }
    return start;
}

}  // namespace

Bends steer(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double insertion_mm, const Way& way,
            const SteeringGoal& goal, const Bends& start) {
    const Vec3 tip = shape(spec, state, rail).tip.position;
    return search(spec, state, rail, insertion_mm, lane_round(way, tip, spec, goal.off), goal, start);
}

Approach approach(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double span_mm,
                  const Way& way, const SteeringGoal& goal, const Bends& start) {
    const Vec3 tip = shape(spec, state, rail).tip.position;
    const std::vector<CentrelineNode> lane = lane_round(way, tip, spec, goal.off);
    Approach out{search(spec, state, rail, state.insertion_mm, lane, goal, start), 0.0};
    for (const double advance : {span_mm, -span_mm}) {
        const double insertion = state.insertion_mm + advance;
        if (insertion < 0.0) continue;
        Bends bends = search(spec, state, rail, insertion, lane, goal, start);
        if (bends.cost < clearly_better * out.bends.cost) out = {std::move(bends), advance};
    }
    return out;
}

}  // namespace cathlab
