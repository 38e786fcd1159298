#include "step/devices.h"

#include <algorithm>
#include <cmath>

#include "catheter/give_way.h"
#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

// From this share of its force limit on the catheter gives way, at the limit at full speed.
constexpr double yielding_from = 0.75;
// How far a command may drive the catheter into the wall in one substep, beyond what the wall has yielded: the wall is
// then never more than this behind, and the device's own limit (0.5 mm) is kept with a margin for its folds.
constexpr double depth_a_substep_mm = 0.15;
// A wire that runs head-on into the wall (more than this against its front end) is fed no faster than so much in a
// substep.
constexpr double head_on_mn = 10.0;
constexpr double head_on_advance_mm = 0.06;
// Rows at most for a sample of the front end, round which the wall folds like a tent.
constexpr int walls_of_a_tip = 4;
// The front of the wire, and of the catheter's shaft behind its segments, is sampled in full; behind it every other
// sample is left out where none of its neighbours within so much came near the wall in the last substep.
constexpr double full_front_mm = 60.0;
constexpr double neighbours_mm = 3.0;

// Where along a device the last substep found the wall near.
class AtTheWall {
public:
    AtTheWall(const ContactSet& contacts, Index device) : arcs_(contacts.arcs_at_the_wall(device)) {}
    bool near(double arc) const {
        const auto it = std::lower_bound(arcs_.begin(), arcs_.end(), arc - neighbours_mm);
        return it != arcs_.end() && *it <= arc + neighbours_mm;
    }

private:
    std::vector<double> arcs_;
};

// Material arc length from the wire's tip of the centre of every link.
std::vector<double> link_centres(const Rod& wire) {
    std::vector<double> centre(wire.link_count());
    double start = 0.0;
    for (std::size_t i = 0; i < centre.size(); ++i) {
        centre[i] = start + 0.5 * wire.link_length(i);
        start += wire.link_length(i);
    }
    return centre;
}

Vec3 point_at(const CatheterShape& shape, double arc) {
    if (arc <= shape.arc.front()) return shape.points.front();
    if (arc >= shape.arc.back()) return shape.points.back();
    const auto it = std::upper_bound(shape.arc.begin(), shape.arc.end(), arc);
    const auto i = static_cast<std::size_t>(it - shape.arc.begin());
    const double t = (arc - shape.arc[i - 1]) / (shape.arc[i] - shape.arc[i - 1]);
    return shape.points[i - 1] + t * (shape.points[i] - shape.points[i - 1]);
}

// Two elastic rods in one another take the curvatures that either would have alone in the ratio of their stiffnesses: a
// stiff guidewire inside leads the steerable part along the vessel and is hardly bent by it.
std::vector<RailLead> led_by_wire(const Parts& p) {
    std::vector<RailLead> leads;
    if (!p.wire || p.catheter->inner_diameter_mm <= 0.0) return leads;
    double front = p.wire->insertion_mm();  // of a section, mm from the mouth
    for (const WireSection& section : p.wire->spec().sections) {
        const bool last = &section == &p.wire->spec().sections.back();
        const double back = last ? 0.0 : front - section.length_mm;
        if (front <= 0.0) break;
        const double ei = section.bending_stiffness_n_mm2;
        leads.push_back({back, front, ei / (ei + p.catheter->bending_stiffness_n_mm2)});
        front = back;
    }
    return leads;
}

// How far beyond its steerable part the catheter's way on is looked at, for where the vessels end.
constexpr double beyond_route_mm = 60.0;

Rail current_rail(const Parts& p) {
    CatheterRoute& route = *p.catheter_route;
    if (route.rail_route != p.catheter_state->route) {
        route.rail_route = p.catheter_state->route;
        route.rail = build_rail(route.graph, route.path, route.rail_route, p.mount->mouth);
        route.insertion_limit_mm = insertion_limit(route.graph, route.path, route.rail_route,
                                                   p.catheter->steerable_length_mm() + beyond_route_mm);
    }
    Rail rail = route.rail;
    if (p.mount->follow_wire && p.wire) {
        const std::vector<Vec3> line = p.wire->polyline();
        std::vector<Vec3> nodes{p.mount->mouth.position};
        const double mouth_arc = p.wire->insertion_mm();
        double arc = 0.0;
        std::size_t last = 0;
        for (; last + 1 < line.size() && arc < mouth_arc - 2.0; ++last)
            arc += std::sqrt((line[last + 1] - line[last]).squaredNorm());
        for (std::size_t i = last; i-- > 0;) nodes.push_back(line[i]);
        if (nodes.size() > 2) {
            const Rail wire_rail = build_rail(p.mount->mouth, nodes, {});
            rail = blend(rail, wire_rail, wire_lead(mouth_arc, base_arc_mm(*p.catheter, *p.catheter_state)));
        }
    }
    rail.leads = led_by_wire(p);
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
        limit.gap = rows[i].normal.dot(now.points[point] - wall[i].point) - wall[i].offset;
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
constexpr double swung_wire_mn = 50.0;

double pace_at_the_wall(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                        const Rail& rail, const CatheterShape& start, double h, double limit_mm) {
    const CatheterShape full = shape(spec, attempt(spec, state, command, 1.0, h, limit_mm), rail);
    const std::size_t common = std::min(start.points.size(), full.points.size());
    double run = 0.0;
    for (std::size_t k = 1; k <= common; ++k)
        run =
            std::max(run, (full.points[full.points.size() - k] - start.points[start.points.size() - k]).squaredNorm());
    run = std::sqrt(run);
    return run > run_a_substep_mm ? run_a_substep_mm / run : 1.0;
}

// The guidewire that sticks out of the catheter has no say in where the catheter takes it.  While it is pressed into
// the wall beyond the limits of its own drive the catheter may only give way, that is
// withdraw and straighten.  True if that took a part of the command.
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

double drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm) {
    const double limit = wire.spec().max_push_n * units::newton;
    const double reaction = advance_mm > 0.0 ? wire.sheath_force_mn() : -wire.sheath_force_mn();
    double fraction = std::clamp((limit - reaction) / (0.2 * limit), 0.0, 1.0);
    if (advance_mm > 0.0) {
        if (drive.head_on_mn > head_on_mn) fraction = std::min(fraction, head_on_advance_mm / advance_mm);
        const double depth = settings.wire_penetration_limit_mm;
        fraction = std::min(fraction, std::clamp((depth - drive.penetration_mm) / (0.5 * depth), 0.0, 1.0));
        const double most = settings.wire_contact_limit_mn;
        fraction = std::min(fraction, std::clamp((most - drive.contact_mn) / (0.2 * most), 0.0, 1.0));
    }
    return fraction;
}

void settle_catheter(Parts& p) {
    p.catheter_route->shape = shape(*p.catheter, *p.catheter_state, current_rail(p));
}

double move_catheter(Parts& p, const Input& input, double h) {
    CatheterState& state = *p.catheter_state;
    CatheterRoute& route = *p.catheter_route;
    const std::vector<Vec3> guide = steering_guide(*p.catheter, route.shape);
    update_route(route.graph, route.path, guide, base_arc_mm(*p.catheter, state), state.route);
    const Rail rail = current_rail(p);
    const CatheterShape start = shape(*p.catheter, state, rail);

    CatheterCommand command;
    const bool selected = input.device >= 0.5;
    command.advance_mm = selected ? input.advance * h : 0.0;
    command.rotate_rad = selected ? input.rotate * units::deg * h : 0.0;
    command.bend_rad = {input.proximal_bend * units::deg, input.distal_bend * units::deg};
    command.direction_rad = {input.proximal_direction * units::deg, input.distal_direction * units::deg};
    command.bend_rad.resize(p.catheter->segments.size(), 0.0);
    command.direction_rad.resize(p.catheter->segments.size(), 0.0);

    const double limit = route.insertion_limit_mm;
    WallAround around = wall_around(p, start);
    std::vector<WallLimit>& limits = around.limits;
    bool held = p.wire && wire_presses(*p.wire_drive, *p.settings) && hold_back(command, state);
    if (around.load > yielding_from) {
        const double share = std::min(1.0, (around.load - yielding_from) / (1.0 - yielding_from));
        const CatheterCommand yielding = give_way(*p.catheter, state, rail, start, around.pushes, share, h);
        // What is left of the operator's push; bends are targets and yield as a whole.
        const double own = command.advance_mm > 0.0 ? (1.0 - share) * command.advance_mm : command.advance_mm;
        command = yielding;
        command.advance_mm += own;
        // On its way out of the load depth alone is left to limit.
        for (WallLimit& l : limits) l.force = 0.0;
        held = true;
    }
    // A wire that sticks out and touches the wall is swung by the catheter: then it, too, is at the wall.
    const bool at_the_wall = !limits.empty() || (p.wire && p.wire_drive->contact_mn > swung_wire_mn);
    const double pace = at_the_wall ? pace_at_the_wall(*p.catheter, state, command, rail, start, h, limit) : 1.0;
    command.advance_mm *= pace;
    command.rotate_rad *= pace;
    CatheterTaken taken = take(*p.catheter, state, command, rail, limits, pace * h, limit);
    state = taken.state;
    route.shape = std::move(taken.shape);
    return held ? 1.0 : std::max(taken.refused, 1.0 - pace);
}

CatheterBore catheter_bore(const Parts& p) {
    if (!p.catheter || !p.wire || p.catheter->inner_diameter_mm <= 0.0) return {};
    const CatheterShape& shape = p.catheter_route->shape;
    return {shape.points, shape.arc};
}

void begin_samples(const Parts& p, const CatheterShape& catheter_before, DeviceSamples& samples) {
    samples.wire.clear();
    samples.wire_arc.clear();
    samples.wire_free.clear();
    samples.link_before.clear();
    samples.list.clear();
    if (p.wire) {
        const Rod& wire = *p.wire;
        wire.samples(p.settings->sample_spacing_mm, samples.wire);
        const std::vector<double> centre = link_centres(wire);
        for (std::size_t i = 0; i < wire.link_count(); ++i)
            samples.link_before.push_back(wire.link_pose(i).orientation);
        const CatheterBore bore = catheter_bore(p);
        const AtTheWall at_wall(*p.contacts, wire_device);
        for (std::size_t i = 0; i < samples.wire.size(); ++i) {
            const RodSample& s = samples.wire[i];
            const auto link = static_cast<std::size_t>(s.link);
            const double arc = centre[link] - s.arm.dot(samples.link_before[link] * Vec3::UnitZ());
            samples.wire_arc.push_back(arc);
            if (inside_bore(bore, wire.insertion_mm() - arc)) continue;
            if (i % 2 != 0 && arc > full_front_mm && !at_wall.near(arc)) continue;
            samples.wire_free.push_back(i);
            DeviceSample d;
            d.position = s.position;
            d.previous = s.position;
            d.radius = s.radius;
            d.device = wire_device;
            d.arc_mm = arc;
            if (arc < 2.0 * s.radius) d.walls = walls_of_a_tip;
            d.link = s.link;
            d.arm = s.arm;
            d.friction = wire.spec().friction;
            samples.list.push_back(d);
        }
    }
    if (p.catheter) {
        const CatheterShape& now = p.catheter_route->shape;
        const AtTheWall at_wall(*p.contacts, catheter_device);
        for (std::size_t k = 0; k < now.points.size(); ++k) {
            const std::size_t i = now.points.size() - 1 - k;        // from the tip
            if (now.arc[i] < p.catheter->outer_diameter_mm) break;  // the sheath's mouth holds what is beside it
            const double from_tip = now.arc.back() - now.arc[i];
            if (k % 2 != 0 && from_tip > p.catheter->steerable_length_mm() + full_front_mm && !at_wall.near(from_tip))
                continue;
            DeviceSample d;
            d.position = now.points[i];
            d.previous = point_at(catheter_before, catheter_before.arc.back() - from_tip);
            d.radius = p.catheter->radius_mm();
            d.device = catheter_device;
            d.arc_mm = from_tip;
            if (from_tip < p.catheter->outer_diameter_mm) d.walls = walls_of_a_tip;
            d.friction = p.catheter->friction;
            d.kinematic = true;
            samples.list.push_back(d);
        }
    }
}

void refresh_samples(const Parts& p, DeviceSamples& samples) {
    if (!p.wire) return;
    const Rod& wire = *p.wire;
    std::vector<Pose> pose(wire.link_count());
    std::vector<Quat> turn(wire.link_count());
    std::vector<Vec3> rotation(wire.link_count());
    for (std::size_t i = 0; i < pose.size(); ++i) {
        pose[i] = wire.link_pose(i);
        turn[i] = pose[i].orientation * samples.link_before[i].conjugate();
        rotation[i] = det::vector_from_rotation(turn[i]);
    }
    // The list keeps the sample's place in the link's own frame: arm_now = turn * arm_before.
    for (std::size_t k = 0; k < samples.wire_free.size(); ++k) {
        const RodSample& s = samples.wire[samples.wire_free[k]];
        const auto link = static_cast<std::size_t>(s.link);
        DeviceSample& d = samples.list[k];
        d.arm = turn[link] * s.arm;
        d.position = pose[link].position + d.arm;
        d.rotation = rotation[link];
    }
}

}  // namespace cathlab
