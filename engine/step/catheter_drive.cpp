#include "step/catheter_drive.h"

#include <algorithm>
#include <cmath>

#include "catheter/give_way.h"
#include "catheter/start.h"
#include "contact/penetration.h"
#include "core/units.h"
#include "step/tip_yield.h"

namespace cathlab {
namespace {

// From this share of its force limit on the catheter gives way, at the limit at full speed.
constexpr double yielding_from = 0.75;
// ... and with this share of its speeds where it is stuck deep in the wall, whatever the force there.
constexpr double stuck_share = 0.1;
// A shaft that was laid over a wire yields sideways, to the vessel's middle, from this share on.
constexpr double sideways_from = 0.4;
// How far a command may drive the catheter into the wall in one substep, beyond what the wall has yielded: the wall is
// then never more than this behind, and the device's own limit (0.5 mm) is kept with a margin for its folds.
constexpr double depth_a_substep_mm = 0.15;
// How far beyond its steerable part the catheter's way on is looked at, for where the vessels end.
constexpr double beyond_route_mm = 60.0;
// The shaft goes over to the rail that route and wire ask for by no more than this in a substep, at the wall and free.
constexpr double shift_at_wall_mm = 0.1;
constexpr double shift_free_mm = 0.5;

// Two elastic rods in one another take the curvatures that either would have alone in the ratio of their stiffnesses: a
// stiff guidewire inside leads the steerable part along the vessel and is hardly bent by it.
std::vector<double> led_by_wire(const Parts& p, const std::vector<double>& arcs) {
    if (!wire_inside(p)) return {};
    std::vector<double> lead;
    lead.reserve(arcs.size());
    const double front = p.wire->insertion_mm();
    for (const double arc : arcs) {
        const WireSection* section = nullptr;
        double end = 0.0;  // of a section, mm from the wire's tip
        for (const WireSection& s : p.wire->spec().sections) {
            section = &s;
            end += s.length_mm;
            if (front - arc < end) break;
        }
        const double ei = section->bending_stiffness_n_mm2;
        lead.push_back(arc < front ? ei / (ei + p.catheter->bending_stiffness_n_mm2) : 0.0);
    }
    return lead;
}

// The wire's line from the sheath's mouth to its tip.
std::vector<Vec3> wire_line(const Parts& p) {
    const std::vector<Vec3> line = p.wire->polyline();
    constexpr double clear_mm = 2.0;  // of the mouth
    double arc = 0.0;
    std::size_t last = 0;
    for (; last + 1 < line.size() && arc < p.wire->insertion_mm() - clear_mm; ++last)
        arc += std::sqrt((line[last + 1] - line[last]).squaredNorm());
    std::vector<Vec3> nodes{p.mount->mouth.position};
    for (std::size_t i = last; i-- > 0;) nodes.push_back(line[i]);
    return nodes;
}

// Which vessels the shaft takes: a wire that is ahead of the tip has chosen them already, otherwise steering does.
void choose_route(Parts& p) {
    CatheterState& state = *p.catheter_state;
    const CatheterRoute& route = *p.catheter_route;
    const double base = base_arc_mm(*p.catheter, state), steerable = p.catheter->steerable_length_mm();
    std::vector<Vec3> guide;
    if (!route.shape.points.empty()) guide = steering_guide(*p.catheter, route.shape);
    double ahead = route_lookahead_mm;
    if (wire_inside(p)) {
        // The rail has to lead the whole steerable part, as far as the wire reaches.
        ahead = std::clamp(p.wire->insertion_mm() - std::max(base, 0.0), ahead, steerable + rail_support_mm({}));
        if (p.wire->insertion_mm() > state.insertion_mm) {
            guide = wire_line(p);
            const std::size_t n = guide.size();
            if (n > 1) guide.push_back(guide[n - 1] + 20.0 * (guide[n - 1] - guide[n - 2]).normalized());
        }
    }
    update_route(route.graph, route.path, guide, base, state.route, ahead);
}

// Where the shaft would lie by its route and wire alone.  yielding: how far it goes back to the vessel's middle, 0
// to 1.
Rail wanted_rail(Parts& p, double yielding) {
    CatheterRoute& route = *p.catheter_route;
    if (route.rail_route != p.catheter_state->route) {
        route.rail_route = p.catheter_state->route;
        route.rail = build_rail(route.graph, route.path, route.rail_route, p.mount->mouth);
        route.insertion_limit_mm = insertion_limit(route.graph, route.path, route.rail_route,
                                                   p.catheter->steerable_length_mm() + beyond_route_mm);
    }
    Rail rail = route.rail;
    if (p.mount->follow_wire && wire_inside(p)) {
        const std::vector<Vec3> line = wire_line(p);
        rail = laid_over_wire(route.laid, route.rail, line.size() > 2 ? build_rail(p.mount->mouth, line, {}) : Rail{},
                              p.catheter_state->insertion_mm, yielding);
    }
    rail.lead = led_by_wire(p, rail.arc);
    return rail;
}

// Rows of the last substep, seen from where the catheter stands now.  The force limit is the whole catheter's: at the
// limit no sample may go further into the wall, and beyond it the catheter gives way to what pushes it.
struct WallAround {
    std::vector<WallLimit> limits;
    std::vector<WallPush> pushes;
    double load = 0.0;  ///< of all force or of that at the tip, the larger share of its limit
};

WallAround wall_around(const Parts& p, const CatheterShape& now) {
    WallAround around;
    const auto rows = p.contacts->rows();
    const auto wall = p.contacts->wall_rows();
    double all = 0.0, tip = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (wall[i].device != catheter_device) continue;
        all += rows[i].multiplier;
        if (wall[i].arc_mm <= p.contacts->settings().tip_length_mm) tip += rows[i].multiplier;
    }
    around.load = std::max(all / (p.catheter->force_limit_n * units::newton),
                           tip / (p.catheter->tip_force_limit_n * units::newton));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (wall[i].device != catheter_device) continue;
        const auto from_tip = static_cast<std::size_t>(std::floor(wall[i].arc_mm / catheter_spacing_mm + 0.5));
        if (from_tip >= now.points.size()) continue;
        const std::size_t point = now.points.size() - 1 - from_tip;
        WallLimit limit;
        limit.point = static_cast<Index>(point);
        limit.normal = rows[i].normal;
        const Vec3 place = now.points[point] + tip_share(*p.catheter, wall[i].arc_mm) * p.catheter_route->yielded;
        limit.gap = rows[i].normal.dot(place - wall[i].point) - wall[i].offset;
        limit.force = around.load * p.catheter->force_limit_n * units::newton;
        limit.penetration_limit = std::min(p.catheter->penetration_limit_mm, depth_a_substep_mm);
        limit.force_limit = p.catheter->force_limit_n * units::newton;
        around.limits.push_back(limit);
        if (rows[i].multiplier > 0.0)
            around.pushes.push_back({limit.point, rows[i].multiplier * rows[i].normal + rows[i].tangent_force});
    }
    return around;
}

// Near the wall no sample may run further than this in a substep: rows hold the wall's place and direction as they were
// when it began, and a tip that rushes along a dented wall would leave both behind.
constexpr double run_a_substep_mm = 0.2;
// ... and where the last substep found it deep in a wall that folds round it, no further than this.
constexpr double run_when_deep_mm = 0.05;
// ... but beyond its force limit it goes along with the wall that presses it: as fast as the heart moves the root.
constexpr double run_when_overloaded_mm = 0.4;
constexpr double swung_wire_mn = 50.0;

// A wire that sticks out and touches the wall is swung by the catheter: then it, too, is at the wall.
bool at_the_wall(const Parts& p, const WallAround& around) {
    return !around.limits.empty() || (p.wire && p.wire_drive->contact_mn > swung_wire_mn);
}

// How far the sample that goes farthest goes, matched from the tip, mm.
double largest_shift(const CatheterShape& from, const CatheterShape& to) {
    const std::size_t common = std::min(from.points.size(), to.points.size());
    double squared = 0.0;
    for (std::size_t k = 1; k <= common; ++k)
        squared =
            std::max(squared, (to.points[to.points.size() - k] - from.points[from.points.size() - k]).squaredNorm());
    return std::sqrt(squared);
}

double pace_at_the_wall(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                        const Rail& rail, const CatheterShape& start, double h, double limit_mm, double most_mm) {
    const double run = largest_shift(start, shape(spec, attempt(spec, state, command, 1.0, h, limit_mm), rail));
    return run > most_mm ? most_mm / run : 1.0;
}

// The shaft goes over to where route and wire want it, as fast as contact can follow, and only as far as the wall lets
// it: not deeper than a command may go, and no further in where the catheter already gives way.
void lay_shaft(Parts& p) {
    CatheterRoute& route = *p.catheter_route;
    WallAround around = wall_around(p, route.shape);
    const double yielding = std::clamp((around.load - sideways_from) / (yielding_from - sideways_from), 0.0, 1.0);
    const Rail wanted = wanted_rail(p, yielding);
    if (wanted.points == route.laid.points && wanted.lead == route.laid.lead) return;
    const auto lie = [&](const Rail& rail) { return shape(*p.catheter, *p.catheter_state, rail); };
    for (WallLimit& limit : around.limits) limit.force_limit *= yielding_from;
    const double shift = largest_shift(route.shape, lie(wanted));
    const double at_wall = route.deep ? run_when_deep_mm : shift_at_wall_mm;
    const double most = at_the_wall(p, around) ? at_wall : shift_free_mm;
    double share = shift > most ? most / shift : 1.0;
    if (!around.limits.empty())
        share *= allowed_fraction(route.shape.points, lie(blend(route.laid, wanted, share)).points, around.limits);
    route.laid = blend(route.laid, wanted, share);
    route.shape = lie(route.laid);
}

// A catheter that starts deeper in the wall than this lies along the vessel instead, or less far in.
constexpr double start_depth_mm = 0.3;
constexpr double start_step_mm = 2.0;

double depth_in_wall(const Parts& p) {
    std::vector<DeviceSample> samples;
    const CatheterShape& lies = p.catheter_route->shape;
    for (std::size_t i = 0; i < lies.points.size(); ++i) {
        if (lies.arc[i] < p.catheter->outer_diameter_mm) continue;  // the sheath's mouth holds what is beside it
        DeviceSample s;
        s.position = lies.points[i];
        s.radius = p.catheter->radius_mm();
        samples.push_back(s);
    }
    return penetration_report(*p.surface, *p.surface_state, samples, p.world->workers()).deepest_mm;
}

// The guidewire that sticks out of the catheter has no say in where the catheter takes it.  While it is pressed into
// the wall beyond the limits of its own drive, or the catheter itself stuck deep in it, the catheter may only give way,
// that is withdraw and straighten.  True if that took a part of the command.
bool wire_presses(const WireDrive& drive, const StepSettings& settings) {
    return drive.penetration_mm > settings.wire_penetration_limit_mm ||
           drive.contact_mn > settings.wire_contact_limit_mn;
}

bool hold_back(CatheterCommand& command, const CatheterState& state) {
    const CatheterCommand wanted = command;
    command.advance_mm = std::min(0.0, command.advance_mm);
    command.rotate_rad = 0.0;
    for (std::size_t k = 0; k < state.bend_rad.size(); ++k) {
        command.bend_rad[k] = std::min(command.bend_rad[k], state.bend_rad[k]);
        command.direction_rad[k] = state.direction_rad[k];
    }
    return command.advance_mm != wanted.advance_mm || command.rotate_rad != wanted.rotate_rad ||
           command.bend_rad != wanted.bend_rad;
}

}  // namespace

void settle_catheter(Parts& p) {
    CatheterState& state = *p.catheter_state;
    const double asked_mm = state.insertion_mm;
    for (;;) {
        choose_route(p);
        p.catheter_route->laid = wanted_rail(p, 0.0);
        p.catheter_route->shape = shape(*p.catheter, state, p.catheter_route->laid);
        if (depth_in_wall(p) <= start_depth_mm) break;
        lie_along(*p.catheter, state, p.catheter_route->laid);
        p.catheter_route->shape = shape(*p.catheter, state, p.catheter_route->laid);
        if (depth_in_wall(p) <= start_depth_mm || state.insertion_mm <= 0.0) break;
        state.insertion_mm = std::max(0.0, state.insertion_mm - start_step_mm);
    }
    if (state.insertion_mm < asked_mm)
        p.event("clamped", catheter_entity,
                "bent as far as it can, the catheter only fits the vessel at this insertion (mm)", state.insertion_mm);
}

double move_catheter(Parts& p, const Input& input, const SegmentBends& bends, double h) {
    CatheterState& state = *p.catheter_state;
    CatheterRoute& route = *p.catheter_route;
    take_back_yield(route);
    choose_route(p);
    lay_shaft(p);
    const Rail& rail = route.laid;
    const CatheterShape start = route.shape;

    CatheterCommand command;
    const bool selected = input.device >= 0.5;
    command.advance_mm = selected ? input.advance * h : 0.0;
    command.rotate_rad = selected ? input.rotate * units::deg * h : 0.0;
    for (std::size_t i = 0; i < p.catheter->segments.size(); ++i) {
        command.bend_rad.push_back(bends.bend_deg[i] * units::deg);
        command.direction_rad.push_back(bends.direction_deg[i] * units::deg);
    }

    const double limit = route.insertion_limit_mm;
    WallAround around = wall_around(p, start);
    std::vector<WallLimit>& limits = around.limits;
    bool held = (route.stuck || (p.wire && wire_presses(*p.wire_drive, *p.settings))) && hold_back(command, state);
    if (around.load > yielding_from || route.stuck) {
        const double least = route.stuck ? stuck_share : 0.0;
        const double share = std::clamp((around.load - yielding_from) / (1.0 - yielding_from), least, 1.0);
        const CatheterCommand yielding = give_way(*p.catheter, state, rail, start, around.pushes, share, h);
        // What is left of the operator's push; bends are targets and yield as a whole.
        const double own = command.advance_mm > 0.0 ? (1.0 - share) * command.advance_mm : command.advance_mm;
        command = yielding;
        command.advance_mm += own;
        if (route.stuck) command.advance_mm = std::min(command.advance_mm, -run_when_deep_mm);
        // On its way out of the load depth alone is left to limit.
        for (WallLimit& l : limits) l.force = 0.0;
        held = true;
    }
    double most_mm = route.deep ? run_when_deep_mm : run_a_substep_mm;
    if (around.load > 1.0)
        most_mm = std::max(most_mm, std::min(run_when_overloaded_mm, run_a_substep_mm * around.load));
    const double pace =
        at_the_wall(p, around) ? pace_at_the_wall(*p.catheter, state, command, rail, start, h, limit, most_mm) : 1.0;
    command.advance_mm *= pace;
    command.rotate_rad *= pace;
    CatheterTaken taken = take(*p.catheter, state, command, rail, limits, pace * h, limit);
    state = taken.state;
    route.shape = std::move(taken.shape);
    give_yield(*p.catheter, route);
    return held ? 1.0 : std::max(taken.refused, 1.0 - pace);
}

bool wire_inside(const Parts& p) {
    constexpr double same_sheath_mm = 1.0;
    return p.catheter && p.wire && p.catheter->inner_diameter_mm > 0.0 &&
           (p.wire->sheath().mouth.position - p.mount->mouth.position).norm() < same_sheath_mm;
}

CatheterBore catheter_bore(const Parts& p) {
    if (!wire_inside(p)) return {};
    const CatheterShape& shape = p.catheter_route->shape;
    return {shape.points, shape.arc};
}

}  // namespace cathlab
