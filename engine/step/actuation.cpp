#include "step/actuation.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

// Pull wires of a 6 Fr catheter: four a segment, in its wall.
constexpr int tendons = 4;
constexpr double tendon_place = 0.75;  // of the outer radius

ActuatedSegment segment_of(const CatheterSegment& spec, double radius_mm, double bend_deg, double direction_deg) {
    ActuatedSegment out;
    out.length_mm = spec.length_mm;
    const double direction = direction_deg * units::deg;
    out.bend_rad = bend_deg * units::deg * Vec2(det::cos(direction), det::sin(direction));
    out.tendon_radius_mm = tendon_place * radius_mm;
    for (int k = 0; k < tendons; ++k) {
        const double place = 2.0 * units::pi * k / tendons;
        out.tendon_rad.push_back(place);
        out.tendon_mm.push_back(out.tendon_radius_mm * out.bend_rad.dot(Vec2(det::cos(place), det::sin(place))));
    }
    return out;
}

void put(const ActuatedSegment& segment, double& bend_deg, double& direction_deg) {
    const double bend = std::sqrt(segment.bend_rad.squaredNorm());
    bend_deg = bend / units::deg;
    if (bend > 0.0) direction_deg = det::atan2(segment.bend_rad.y(), segment.bend_rad.x()) / units::deg;
}

}  // namespace

SegmentBends commanded_bends(const CatheterSpec& spec, const Input& input) {
    SegmentBends out;
    for (std::size_t i = 0; i < spec.segments.size(); ++i) {
        const std::string by = spec.driven_by(i);
        const bool distal = by == "distal";
        out.bend_deg.push_back(by == "none" ? 0.0 : distal ? input.distal_bend : input.proximal_bend);
        out.direction_deg.push_back(by == "none" ? 0.0 : distal ? input.distal_direction : input.proximal_direction);
    }
    return out;
}

void actuate(Parts& p, const EffectContext& context, Input& input, SegmentBends& bends) {
    unsigned hooks = 0;
    for (const ActiveEffect* active : p.effects) hooks |= active->info->hooks;
    if (!p.catheter || (hooks & hook_actuation) == 0) return;
    CatheterTravel& travel = *p.world->first<CatheterTravel>();

    const bool selected = input.device >= 0.5;
    const double dt = context.dt;
    if (selected) {
        travel.commanded_mm += input.advance * dt;
        travel.commanded_rad += input.rotate * units::deg * dt;
    }
    Actuation act;
    act.insertion_mm = travel.commanded_mm;
    act.rotation_rad = travel.commanded_rad;
    act.link_length_mm = p.catheter->link_length_mm;
    act.tip_length_mm = p.catheter->tip_length_mm;
    const Vec3& gravity = p.settings->gravity_mm_s2;
    if (gravity != Vec3::Zero())
        act.down = p.catheter_route->shape.base.orientation.conjugate() * (gravity / std::sqrt(gravity.squaredNorm()));
    const auto& segments = p.catheter->segments;
    const double radius = p.catheter->radius_mm();
    for (std::size_t i = 0; i < segments.size(); ++i)
        act.segments.push_back(segment_of(segments[i], radius, bends.bend_deg[i], bends.direction_deg[i]));

    p.each_effect(hook_actuation, [&](Effect& effect) { effect.actuation(context, act); });
    p.catheter_route->tip_compliance_mm_per_n = act.tip_compliance_mm_per_n;

    const bool tapered =
        std::any_of(act.segments.begin(), act.segments.end(), [](const ActuatedSegment& s) { return s.taper != 0.0; });
    if (tapered) {
        p.catheter_state->taper.clear();
        for (const ActuatedSegment& s : act.segments) p.catheter_state->taper.push_back(s.taper);
    }
    for (std::size_t i = 0; i < act.segments.size(); ++i)
        put(act.segments[i], bends.bend_deg[i], bends.direction_deg[i]);
    // While the hand is on the other device the catheter's shaft is held at the sheath.
    if (!selected || dt <= 0.0) return;
    const ActionInfo& advance = *find_action("advance");
    const ActionInfo& rotate = *find_action("rotate");
    input.advance = std::clamp((act.insertion_mm - travel.taken_mm) / dt, advance.minimum, advance.maximum);
    input.rotate = std::clamp((act.rotation_rad - travel.taken_rad) / units::deg / dt, rotate.minimum, rotate.maximum);
    travel.taken_mm += input.advance * dt;
    travel.taken_rad += input.rotate * units::deg * dt;
}

}  // namespace cathlab
