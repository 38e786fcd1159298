#include "step/devices.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"
#include "step/catheter_drive.h"
#include "step/tip_yield.h"

namespace cathlab {
namespace {

// A wire that runs head-on into the wall (more than this against its front end) is fed no faster than so much in a
// substep.
constexpr double head_on_mn = 10.0;
constexpr double head_on_advance_mm = 0.06;
// How fast a wire slips through rollers that hold it against twice what they can.
constexpr double slip_mm_s = 40.0;
// Rows at most for a sample of the front end, round which the wall folds like a tent.
constexpr int walls_of_a_tip = 4;
// The front of the wire, and of the catheter's shaft behind its segments, is sampled in full; behind it every other
// sample is left out where none of its neighbours within so much came near the wall in the last substep.
constexpr double full_front_mm = 60.0;
constexpr double neighbours_mm = 3.0;
// Links, and samples, that are worth a thread of their own.
constexpr std::size_t link_grain = 48;
constexpr std::size_t sample_grain = 128;

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

double fraction_below(double limit, double push_mn, const WireDrive& drive, const StepSettings& settings,
                      double advance_mm) {
    const double reaction = advance_mm > 0.0 ? push_mn : -push_mn;
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

}  // namespace

double drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm) {
    return fraction_below(wire.spec().max_push_n * units::newton, wire.sheath_force_mn(), drive, settings, advance_mm);
}

double sleeve_drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm) {
    return fraction_below(wire.sleeve_spec().max_push_n * units::newton, wire.sleeve_force_mn(), drive, settings,
                          advance_mm);
}

double drive_slip(const Rod& wire, double h) {
    const double limit = wire.spec().max_push_n * units::newton, force = wire.sheath_force_mn();
    const double excess = std::clamp(std::fabs(force) / limit - 1.0, 0.0, 1.0);
    return std::copysign(excess * slip_mm_s * h, -force);
}

void begin_samples(const Parts& p, const CatheterShape& catheter_before, DeviceSamples& samples) {
    samples.wire.clear();
    samples.wire_arc.clear();
    samples.wire_free.clear();
    samples.link_before.clear();
    samples.catheter_before.clear();
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
            const bool tube = wire.has_sleeve() && link >= wire.front_count();
            d.friction = tube ? wire.sleeve_spec().friction : wire.spec().friction;
            samples.list.push_back(d);
        }
    }
    if (p.catheter) {
        const CatheterShape& now = p.catheter_route->shape;
        for (const double arc : now.arc)
            samples.catheter_before.push_back(
                point_at(catheter_before, catheter_before.arc.back() - (now.arc.back() - arc)));
        const AtTheWall at_wall(*p.contacts, catheter_device);
        for (std::size_t k = 0; k < now.points.size(); ++k) {
            const std::size_t i = now.points.size() - 1 - k;        // from the tip
            if (now.arc[i] < p.catheter->outer_diameter_mm) break;  // the sheath's mouth holds what is beside it
            const double from_tip = now.arc.back() - now.arc[i];
            if (k % 2 != 0 && from_tip > p.catheter->steerable_length_mm() + full_front_mm && !at_wall.near(from_tip))
                continue;
            DeviceSample d;
            d.position = now.points[i];
            d.previous = samples.catheter_before[i];
            d.radius = p.catheter->radius_mm();
            d.device = catheter_device;
            d.arc_mm = from_tip;
            if (from_tip < p.catheter->outer_diameter_mm) d.walls = walls_of_a_tip;
            d.friction = p.catheter->friction;
            if (p.catheter_route->tip_compliance_mm_per_n > 0.0) d.yields = tip_share(*p.catheter, from_tip);
            d.kinematic = true;
            samples.list.push_back(d);
        }
    }
}

void refresh_samples(const Parts& p, DeviceSamples& samples) {
    if (!p.wire) return;
    const Rod& wire = *p.wire;
    const Workers& workers = p.world->workers();
    samples.link_turn.resize(wire.link_count());
    samples.link_rotation.resize(wire.link_count());
    workers.for_ranges(wire.link_count(), link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            samples.link_turn[i] = wire.link_pose(i).orientation * samples.link_before[i].conjugate();
            samples.link_rotation[i] = det::vector_from_rotation(samples.link_turn[i]);
        }
    });
    // The list keeps the sample's place in the link's own frame: arm_now = turn * arm_before.
    workers.for_ranges(samples.wire_free.size(), sample_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const RodSample& s = samples.wire[samples.wire_free[k]];
            const auto link = static_cast<std::size_t>(s.link);
            DeviceSample& d = samples.list[k];
            d.arm = samples.link_turn[link] * s.arm;
            d.position = wire.link_pose(link).position + d.arm;
            d.rotation = samples.link_rotation[link];
        }
    });
}

}  // namespace cathlab
