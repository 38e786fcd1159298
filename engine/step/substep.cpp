#include "step/substep.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "step/catheter_drive.h"
#include "step/devices.h"
#include "step/last_resort.h"
#include "step/tip_yield.h"
#include "step/wall_forces.h"
#include "step/wire_weight.h"

namespace cathlab {
namespace {

// The catheter is kinematic; this is how far its bore yields to the wire, mm/mN, at points this far apart: 0.2 mm under
// 1 N, the clearance of a 0.035 in wire in a 6 Fr lumen.  Small beside the wall's 0.01 mm/mN.
constexpr double bore_compliance = 2e-4;
constexpr double bore_spacing_mm = 2.5;
// The outside of the catheter against a wire beside it: 0.2 mm under 1 N, too.  What lies deeper in (a scene may begin
// so) is pushed out by 0.5 N a sample.
constexpr double outside_compliance = 2e-4;
constexpr double outside_deepest_mm = 0.1;
// The wire that comes out of the catheter's tip, or both out of one sheath, may lie along each other for so long.
constexpr double leaving_diameters = 3.0;
// Sweeps over the catheter's rows in a pass: cheap beside a fit of the clusters.
constexpr int kinematic_sweeps = 6;
// The chain is solved again at once, against the wall that has yielded to it, while it is pressed in deeper than this.
constexpr int wire_solves = 8;
constexpr double wire_depth_mm = 0.1;
// The front end of the wire: what pushes back there stops it.
constexpr double front_mm = 3.0;
// A pass is repeated, with contacts looked for anew, while device and wall slid past each other by more than this.
constexpr double stale_mm = 0.2;
// ... or while a sample that presses with more than so much, at a front end that presses at all, is deeper in the wall,
// as it then lies, than its rows say.
constexpr double pressed_mn = 100.0;
constexpr double front_pressed_mn = 2.0;
constexpr double pressed_depth_mm = 0.25;
constexpr int extra_passes = 8;
// After so many of them a catheter that is still too deep goes back to where it stood, and the rest is for that.
constexpr int passes_to_go_back = 3;
// Within a step the lumen surface follows the wall up to this far from the devices.
constexpr double surface_reach_mm = 4.5;
// ... and for a look at the true depth up to this far from what presses: no closest point asks further
// (closest_point.cpp, hint_reach_mm and what is added to it), and the wall has moved a little since its boxes were
// fitted.
constexpr double true_depth_reach_mm = 7.5;

void command_wire(Parts& p, const Input& input, double h, StepSums& sums) {
    if (p.wire_mouth) p.wire->move_mouth(place_now(*p.wire_mouth, *p.wall, p.wall_state->x));
    const bool selected = input.device < 0.5;
    const double wanted = selected ? input.advance * h : 0.0;
    const double fraction = wanted == 0.0 ? 1.0 : drive_fraction(*p.wire, *p.wire_drive, *p.settings, wanted);
    const double slip = p.wire->has_sleeve() ? 0.0 : drive_slip(*p.wire, h);
    const double taken = p.wire->command(fraction * wanted + slip, selected ? input.rotate * units::deg * h : 0.0);
    sums.wire_refused_mm += wanted - taken;
    p.wire_drive->refused_mm += std::fabs(wanted - taken);
    if (!p.wire->has_sleeve()) return;
    const double fed = selected ? 0.0 : input.advance * h;
    const double share = fed == 0.0 ? 1.0 : sleeve_drive_fraction(*p.wire, *p.wire_drive, *p.settings, fed);
    const double sleeve_taken = p.wire->command_sleeve(share * fed, selected ? 0.0 : input.rotate * units::deg * h);
    if (fed != 0.0)
        sums.catheter_refused = std::max(sums.catheter_refused, std::clamp(1.0 - sleeve_taken / fed, 0.0, 1.0));
}

// Of the contacts of a wire with a passive catheter over it: what is the catheter's, from its tip on.
void add_sleeve_report(const Parts& p, StepSums& sums) {
    const auto rows = p.contacts->rows();
    const auto wall = p.contacts->wall_rows();
    const double tip = std::max(0.0, p.wire->insertion_mm() - p.wire->sleeve_insertion_mm());
    const double tip_length = p.contacts->settings().tip_length_mm;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (wall[i].device != wire_device || wall[i].arc_mm < tip) continue;
        const double force = rows[i].multiplier;
        sums.catheter_penetration_mm = std::max(sums.catheter_penetration_mm, -rows[i].gap);
        if (force <= 0.0) continue;
        sums.catheter_mn += force;
        sums.wire_mn -= force;
        ++sums.catheter_contacts;
        --sums.wire_contacts;
        if (wall[i].arc_mm <= tip_length) sums.wire_tip_mn -= force;
        if (wall[i].arc_mm <= tip + tip_length) sums.catheter_tip_mn += force;
    }
}

// The wire's rows against the wall and against the bore, as one span for one chain solve.
void solve_wire(Parts& p, const DeviceSamples& samples, double h, std::vector<ChainRow>& rows,
                std::vector<ChainRow>& bore_rows) {
    const std::span<ChainRow> wall_rows = p.contacts->chain_rows(wire_device);
    rows.assign(wall_rows.begin(), wall_rows.end());
    if (p.catheter) {
        std::vector<ChainRow> fresh;
        std::vector<RodSample> now = samples.wire;
        std::vector<SampleMotion> motion(now.size());
        std::vector<double> from_mouth;
        const double insertion = p.wire->insertion_mm();
        for (std::size_t i = 0; i < now.size(); ++i) {
            const auto link = static_cast<std::size_t>(now[i].link);
            now[i].arm = samples.link_turn[link] * now[i].arm;
            now[i].position = p.wire->link_pose(link).position + now[i].arm;
            motion[i] = {now[i].position - samples.wire[i].position, samples.link_rotation[link]};
            from_mouth.push_back(insertion - samples.wire_arc[i]);
        }
        const CatheterBore bore = catheter_bore(p);
        add_bore_rows(bore, now, from_mouth, bore_spacing_mm, bore_compliance, fresh);
        std::vector<std::size_t> beside;
        const double ahead = leaving_diameters * p.catheter->outer_diameter_mm;
        for (const std::size_t i : samples.wire_free)
            if (bore.arc.empty() || from_mouth[i] > bore.arc.back() + ahead) beside.push_back(i);
        const CatheterShape& lies = p.catheter_route->shape;
        add_outside_rows({{lies.points, lies.arc},
                          p.catheter->radius_mm(),
                          outside_compliance,
                          p.settings->contact_margin_mm,
                          outside_deepest_mm,
                          ahead,
                          p.catheter->wire_friction,
                          samples.catheter_before},
                         now, motion, beside, fresh);
        bore_rows = std::move(fresh);
        rows.insert(rows.end(), bore_rows.begin(), bore_rows.end());
    }
    p.wire->solve(h, rows, p.world->workers());
    std::copy(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(wall_rows.size()), wall_rows.begin());
}

// How deep the samples that press hard are in the wall as the last pass left it.
TrueDepth pressed_depth(Parts& p, const DeviceSamples& samples, StepSums& sums) {
    const std::vector<Vec3> places = p.contacts->pressing(samples.list, pressed_mn, front_pressed_mn);
    if (places.empty()) return {};
    const TreePart near =
        part_near(p.surface->tree, p.surface_state->boxes, places, true_depth_reach_mm, &*sums.surface_near);
    update(*p.surface, p.wall_state->x, near, *p.surface_state, p.world->workers());
    return p.contacts->true_depth(*p.surface, *p.surface_state, samples.list, pressed_mn, front_pressed_mn);
}

// Rows for the samples where they are now, against the wall at `particles`.  The surface follows as a whole once a
// step, and then where devices are.
void find_contacts(Parts& p, const DeviceSamples& samples, std::span<const Vec3> particles, StepSums& sums,
                   bool again = false) {
    const Workers& workers = p.world->workers();
    if (sums.surface_near) {
        update(*p.surface, particles, *sums.surface_near, *p.surface_state, workers);
    } else {
        update(*p.surface, particles, *p.surface_state, workers);
        std::vector<Vec3> places;
        for (const DeviceSample& s : samples.list) places.push_back(s.position);
        sums.surface_near = part_near(p.surface->tree, p.surface_state->boxes, places, surface_reach_mm);
    }
    p.contacts->detect(*p.surface, *p.surface_state, samples.list, p.settings->contact_margin_mm, p.wall_scratch->start,
                       p.wall_scratch->compliance, p.world->workers(), again);
}

// Where the catheter stood.
struct CatheterPlace {
    CatheterState state;
    Rail laid;
    CatheterShape shape, driven;
};

CatheterPlace place_of(const Parts& p) {
    return {*p.catheter_state, p.catheter_route->laid, p.catheter_route->shape, p.catheter_route->driven};
}

// Its motion of this substep undone: the wall could not follow.
void go_back(Parts& p, const CatheterPlace& place, DeviceSamples& samples, std::optional<TipYield>& tip,
             StepSums& sums) {
    *p.catheter_state = place.state;
    p.catheter_route->laid = place.laid;
    p.catheter_route->shape = place.shape;
    p.catheter_route->driven = place.driven;
    if (tip) tip->way = tip->start;
    samples.catheter_before = place.shape.points;
    for (DeviceSample& s : samples.list)
        if (s.kinematic) s.position = s.previous;
    sums.catheter_refused = 1.0;
}

void add_report(const Parts& p, const ContactReport& report, StepSums& sums) {
    for (const DeviceContact& d : report.devices) {
        if (d.device == wire_device) {
            sums.wire_mn += d.normal_mn;
            sums.wire_tip_mn += d.tip_mn;
            sums.wire_contacts = d.active;
            sums.wire_penetration_mm = std::max(sums.wire_penetration_mm, d.penetration_mm);
        } else {
            sums.catheter_mn += d.normal_mn;
            sums.catheter_tip_mn += d.tip_mn;
            sums.catheter_contacts = d.active;
            sums.catheter_penetration_mm = std::max(sums.catheter_penetration_mm, d.penetration_mm);
        }
    }
    sums.imbalance = std::max(sums.imbalance, report.force_imbalance);
    if (p.wire && p.wire->has_sleeve()) {
        sums.catheter_contacts = 0;
        add_sleeve_report(p, sums);
    }
    const auto rows = p.contacts->rows();
    const auto wall = p.contacts->wall_rows();
    sums.tip_region = -1;
    double strongest = 0.0;
    if (p.wire_drive) {
        p.wire_drive->contact_mn = 0.0;
        p.wire_drive->penetration_mm = 0.0;
        p.wire_drive->head_on_mn = 0.0;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (wall[i].device == wire_device && p.wire_drive) {
            p.wire_drive->contact_mn = std::max(p.wire_drive->contact_mn, rows[i].multiplier);
            p.wire_drive->penetration_mm = std::max(p.wire_drive->penetration_mm, -rows[i].gap);
            if (wall[i].arc_mm < front_mm)
                p.wire_drive->head_on_mn -=
                    rows[i].multiplier * rows[i].normal.dot(p.wire->link_pose(0).orientation * Vec3::UnitZ());
        }
        const bool sleeve = p.wire && p.wire->has_sleeve() && wall[i].device == wire_device;
        const double front = sleeve ? std::max(0.0, p.wire->insertion_mm() - p.wire->sleeve_insertion_mm()) : 0.0;
        const bool behind = sleeve && wall[i].arc_mm >= front;
        if (wall[i].arc_mm - (behind ? front : 0.0) <= p.contacts->settings().tip_length_mm &&
            rows[i].multiplier > strongest) {
            strongest = rows[i].multiplier;
            sums.tip_region = wall[i].region;
            sums.tip_device = behind ? catheter_device : wall[i].device;
        }
    }
}

}  // namespace

void substep(Parts& p, const Input& input, const SegmentBends& bends, const Drive& drive,
             std::span<const Vec3> support_before, std::span<const Vec3> support_after, double s1, double time_s,
             double h, StepSums& sums) {
    const SoftBodyModel& wall = *p.wall;
    SoftBodyState& state = *p.wall_state;
    SoftBodyScratch& scratch = *p.wall_scratch;
    const Workers& workers = p.world->workers();
    const EffectContext context = effect_context(p, time_s, h);

    // 1. Commands and supports: what moves by itself.
    p.stage("catheter");
    CatheterPlace catheter_before;
    const bool gives_way = p.catheter && p.catheter_route->stuck;  // that is not undone
    if (p.catheter) {
        catheter_before = place_of(p);
        sums.catheter_refused = std::max(sums.catheter_refused, move_catheter(p, input, bends, h));
    }
    p.stage("rod");
    if (p.wire) command_wire(p, input, h, sums);
    DeviceSamples samples;
    begin_samples(p, catheter_before.shape, samples);
    if (p.wire) p.wire->predict(h, wire_weight(*p.wire, p.settings->gravity_mm_s2), workers);

    p.stage("effects");
    WallForces extra(p, context);
    p.stage("softbody");
    predict(wall, state, scratch, h, SupportMotion(support_before, support_after, s1), extra.external(), workers);

    // 2. Contacts, against the wall where it was when the substep began: the prediction is inertia alone, and a wall
    // that leans on a device would be looked for where the device is not.
    p.stage("contact");
    refresh_samples(p, samples);
    find_contacts(p, samples, scratch.start, sums);
    p.stage("heart");
    extra.detect_heart(p, drive, h);

    // 3. Clusters, chain and rows in turn.  Goals are applied under the old forces before the rows are looked at, so
    // that a row sees the gap that the wall would really leave.
    std::vector<ChainRow> rows;
    std::vector<ChainRow> bore_rows;
    std::optional<TipYield> tip;
    if (p.catheter && p.catheter_route->tip_compliance_mm_per_n > 0.0) tip = tip_yield(*p.catheter, *p.catheter_route);
    int passes = p.settings->iterations;
    bool looked_again = false, too_deep = false, catheter_deep = false, went_back = false;
    TrueDepth deepest;
    WallPart touched;  // by devices and heart: passes after the first look at the wall around them alone
    for (int pass = 0; pass < passes; ++pass) {
        p.stage("softbody");
        if (pass == 0) {
            extra.gather(p);
            solve_and_apply(wall, state, scratch, h, 1, workers);
        } else {
            solve_goals(wall, state, scratch, touched, workers);
            extra.gather(p);
            apply(wall, state, scratch, h, touched, workers);
        }

        p.stage("contact");
        p.contacts->refresh(samples.list, state.x, workers);
        for (int k = 0; p.wire && k < wire_solves && (k == 0 || p.contacts->deepest(wire_device) > wire_depth_mm);
             ++k) {
            p.stage("rod");
            const std::span<ChainRow> wall_rows = p.contacts->chain_rows(wire_device);
            const std::vector<ChainRow> before(wall_rows.begin(), wall_rows.end());
            solve_wire(p, samples, h, rows, bore_rows);
            p.stage("contact");
            p.contacts->yield(wire_device, before, state.x, scratch.compliance);
            limit_speed(wall, state, scratch, h, p.contacts->touched());
            refresh_samples(p, samples);
            p.contacts->refresh(samples.list, state.x, workers);
        }
        if (tip) {
            const Vec3 held = tip->way;
            p.contacts->solve_kinematic(samples.list, state.x, scratch.compliance, kinematic_sweeps, &*tip);
            follow_tip(samples.list, held, tip->way);
        } else {
            p.contacts->solve_kinematic(samples.list, state.x, scratch.compliance, kinematic_sweeps);
        }
        extra.solve(p);

        p.stage("softbody");
        if (pass == 0 || looked_again) {
            std::vector<Index> particles;
            p.contacts->add_touched(particles);
            extra.add_touched(particles);
            touched = part_around(wall, particles);
        }
        extra.gather(p);
        apply_touched(wall, state, scratch, h, touched);

        // Where wall and device slid past each other, the rows speak of another place: look again, and once more.
        p.stage("contact");
        p.contacts->refresh(samples.list, state.x, workers);
        if (pass + 1 < passes) continue;
        deepest = pressed_depth(p, samples, sums);
        too_deep = deepest.mm > pressed_depth_mm;
        // The wire in it goes where the catheter takes it.
        const bool by_catheter = p.catheter && too_deep && (deepest.device == catheter_device || wire_inside(p));
        catheter_deep = catheter_deep || by_catheter;
        if (passes < p.settings->iterations + extra_passes && (too_deep || p.contacts->staleness() > stale_mm)) {
            if (by_catheter && !went_back && !gives_way && passes >= p.settings->iterations + passes_to_go_back) {
                go_back(p, catheter_before, samples, tip, sums);
                went_back = true;
            }
            find_contacts(p, samples, state.x, sums, true);
            looked_again = true;
            ++passes;
        }
    }

    // 4. Velocities from positions, forces from multipliers.
    finish(wall, state, scratch, h, workers);
    if (tip) {
        take_back_yield(*p.catheter_route);
        p.catheter_route->yielded = tip->way;
        give_yield(*p.catheter, *p.catheter_route);
    }
    // Rows that spoke of another place to the last have not seen all that is too deep either.
    const bool deep =
        too_deep || (passes == p.settings->iterations + extra_passes && p.contacts->staleness() > stale_mm);
    if (deep || s1 >= 1.0) {
        p.stage("contact");
        take_out_of_wall(p, samples.list, *sums.surface_near, deep);
        p.contacts->refresh(samples.list, state.x, workers);
    }
    p.stage("rod");
    if (p.wire) {
        p.wire->finish(h, workers);
        sums.wire_sheath_mn += p.wire->sheath_force_mn();
    }
    p.stage("contact");
    add_report(p, p.contacts->report(state.x), sums);
    // What the passes did not get out of the wall is not to be driven on.
    if (p.catheter_route) {
        p.catheter_route->deep = catheter_deep;
        p.catheter_route->stuck = too_deep && deepest.device == catheter_device;
    }
    if (p.wire_drive && too_deep && deepest.device == wire_device)
        p.wire_drive->penetration_mm = std::max(p.wire_drive->penetration_mm, deepest.mm);
    ++sums.substeps;
}

}  // namespace cathlab
