#include "step/measure.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "softbody/observe.h"
#include "step/catheter_drive.h"
#include "step/devices.h"

namespace cathlab {
namespace {

// What is refused below these is rounding and not an event.
constexpr double refused_advance_mm = 1e-6;
constexpr double refused_part = 1e-6;

void put(double& x, double& y, double& z, const Vec3& p) {
    x = p.x();
    y = p.y();
    z = p.z();
}

void measure_wire(const Parts& p, const StepSums& sums, double n, Channels& c) {
    c.wire_insertion_mm = p.wire->insertion_mm();
    c.wire_rotation_deg = p.wire->rotation_rad() / units::deg;
    put(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm, p.wire->tip());
    c.wire_force_mn = sums.wire_mn / n;
    c.wire_tip_force_mn = sums.wire_tip_mn / n;
    c.wire_sheath_force_mn = sums.wire_sheath_mn / n;
    c.wire_contacts = static_cast<double>(sums.wire_contacts);
    c.wire_penetration_mm = sums.wire_penetration_mm;
    c.wire_stretch_max = p.wire->max_stretch();
    c.wire_refused_mm = p.wire_drive->refused_mm;
    if (std::fabs(sums.wire_refused_mm) > refused_advance_mm)
        p.event("refused", wire_entity, "the drive of the guidewire slipped (mm not taken)", sums.wire_refused_mm);
}

void measure_catheter_contact(const StepSums& sums, double n, Channels& c) {
    c.catheter_force_mn = sums.catheter_mn / n;
    c.catheter_tip_force_mn = sums.catheter_tip_mn / n;
    c.catheter_contacts = static_cast<double>(sums.catheter_contacts);
    c.catheter_penetration_mm = sums.catheter_penetration_mm;
    c.catheter_refused = sums.catheter_refused;
}

// A passive catheter over the wire.
void measure_sleeve(const Parts& p, const StepSums& sums, double n, Channels& c) {
    c.catheter_insertion_mm = p.wire->sleeve_insertion_mm();
    c.catheter_rotation_deg = p.wire->sleeve_rotation_rad() / units::deg;
    put(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm, p.wire->sleeve_tip());
    measure_catheter_contact(sums, n, c);
    if (sums.catheter_refused > refused_part)
        p.event("refused", catheter_entity, "the drive of the catheter slipped (part not taken)",
                sums.catheter_refused);
}

void measure_catheter(const Parts& p, const StepSums& sums, double n, Channels& c) {
    const CatheterState& state = *p.catheter_state;
    c.catheter_insertion_mm = state.insertion_mm;
    c.catheter_rotation_deg = state.rotation_rad / units::deg;
    for (std::size_t i = state.bend_rad.size(); i-- > 0;)  // the first of several that follow proximal
        if (p.catheter->driven_by(i) == "proximal") c.catheter_proximal_bend_deg = state.bend_rad[i] / units::deg;
    for (std::size_t i = 0; i < state.bend_rad.size(); ++i)  // the last of several that follow distal
        if (p.catheter->driven_by(i) == "distal") c.catheter_distal_bend_deg = state.bend_rad[i] / units::deg;
    put(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm, p.catheter_route->shape.tip.position);
    measure_catheter_contact(sums, n, c);
    if (sums.catheter_refused > refused_part)
        p.event("refused", catheter_entity, "the wall took a part of the catheter's command only (part refused)",
                sums.catheter_refused);
}

// Points outside the lumen by more than their radius, from the rows: a sample with no row is further inside than the
// margin.
double count_outside(const Parts& p) {
    double outside = 0.0;
    const auto rows = p.contacts->rows();
    const auto wall = p.contacts->wall_rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].gap < -2.0 * wall[i].radius) outside += 1.0;
    return outside;
}

}  // namespace

void measure(Parts& p, const Input& /*input*/, const StepSums& sums, Channels& c) {
    p.stage("measure");
    const double n = static_cast<double>(sums.substeps);
    c.time_s = p.world->time_s;
    if (p.wire) measure_wire(p, sums, n, c);
    if (p.catheter) measure_catheter(p, sums, n, c);
    if (p.wire && p.wire->has_sleeve()) measure_sleeve(p, sums, n, c);

    // The force bar's rule: counted while a tip is in contact, along that device's whole shaft.
    const bool touching = sums.tip_region >= 0;
    if (touching) p.force_bar->limit_n = p.anatomy->regions[static_cast<std::size_t>(sums.tip_region)].force_limit_n;
    const double shaft = !touching ? 0.0 : (sums.tip_device == wire_device ? sums.wire_mn : sums.catheter_mn) / n;
    const double last = c.force_bar;
    c.force_bar_n = p.force_bar->add(shaft);
    c.force_limit_n = p.force_bar->limit_n;
    c.force_bar = c.force_bar_n / c.force_limit_n;
    if (c.force_bar >= 1.0 && last < 1.0)
        p.event("limit", sums.tip_device == wire_device ? wire_entity : catheter_entity,
                "the force bar passed the region's limit (N)", c.force_bar_n);

    c.outside_count = count_outside(p);
    c.momentum_residual = sums.imbalance;
    c.wall_displacement_max_mm = largest_displacement(*p.wall, *p.wall_state);
    c.wall_kinetic_energy_uj = kinetic_energy(*p.wall, *p.wall_state);
    double support = 0.0;
    for (const Vec3& u : p.supports->displacement) support = std::max(support, u.squaredNorm());
    c.support_displacement_mm = std::sqrt(support);

    if (p.beam) {
        const BeamState& beam = *p.beam_state;
        c.beam_on = beam.pedal ? 1.0 : 0.0;
        c.beam_time_s = beam.beam_time_s;
        c.tube_voltage_kvp = beam.kvp;
        c.detector_kerma_ngy = beam.detector_kerma_ngy;
        c.air_kerma_mgy = beam.air_kerma_mgy;
        c.dose_area_product_gycm2 = beam.dose_area_gycm2;
        c.primary_angle_deg = beam.primary_deg;
        c.secondary_angle_deg = beam.secondary_deg;
        c.table_longitudinal_mm = beam.table_longitudinal_mm;
        c.table_lateral_mm = beam.table_lateral_mm;
        c.exposures = static_cast<double>(beam.frames);
        c.exposure_series = static_cast<double>(beam.series);
        c.acquisition = static_cast<double>(beam.acquisition);
        c.roadmap = beam.roadmap ? 1.0 : 0.0;
        c.references = static_cast<double>(beam.references);
        c.collimator_width = beam.collimator_width;
        c.collimator_height = beam.collimator_height;
    }
    if (p.contrast) c.contrast_injected_ml = p.contrast_state->injected_ml;

    if (p.heart) {
        c.heart_phase = p.heart_state->phase;
        c.heart_displacement_mm = p.heart_state->displacement_mm;
        double sum = 0.0;
        for (const Index i : p.annulus->particles) {
            const auto k = static_cast<std::size_t>(i);
            sum += (p.wall_state->x[k] - p.wall->rest[k]).dot(p.annulus->axis);
        }
        if (!p.annulus->particles.empty())
            c.annulus_displacement_mm = sum / static_cast<double>(p.annulus->particles.size());
    }
}

void advance_imaging(Parts& p, const Input& input, double dt) {
    if (p.beam) {
        p.stage("beam");
        const BeamState& now = *p.beam_state;
        const CArmPose pose =
            c_arm_pose(p.beam->c_arm, isocentre_in_patient(*p.beam, now.table_longitudinal_mm, now.table_lateral_mm),
                       now.primary_deg, now.secondary_deg);
        const bool pedal = input.fluoroscopy >= 0.5;
        // The thickness is looked up where it is needed: while the beam is off nothing depends on it.
        const double water_mm = pedal && p.thickness ? p.thickness->water_mm(p.beam->c_arm, pose) : 0.0;
        BeamCommand command{input.primary_angle, input.secondary_angle, pedal, input.table_longitudinal,
                            input.table_lateral};
        command.acquisition = input.acquisition >= 1.5   ? Acquisition::dsa
                              : input.acquisition >= 0.5 ? Acquisition::cine
                                                         : Acquisition::fluoroscopy;
        command.level = input.fluoroscopy_level >= 1.5   ? FluoroscopyLevel::high
                        : input.fluoroscopy_level >= 0.5 ? FluoroscopyLevel::normal
                                                         : FluoroscopyLevel::low;
        command.collimator_width = input.collimator_width;
        command.collimator_height = input.collimator_height;
        command.roadmap = input.roadmap >= 0.5;
        command.reference = input.reference >= 0.5;
        advance(*p.beam, *p.beam_state, command, water_mm, p.world->step_index - 1, dt);
    }
    if (p.contrast) {
        p.stage("contrast");
        Injection injection;
        injection.flow_ml_s = input.contrast;
        const bool by_catheter = p.catheter && (input.device >= 0.5 || !p.wire);
        if (p.wire && p.wire->has_sleeve() && input.device >= 0.5)
            injection.node = p.anatomy->centreline.nearest(p.wire->sleeve_tip());
        else if (by_catheter)
            injection.node = p.anatomy->centreline.nearest(p.catheter_route->shape.tip.position);
        else if (p.wire)
            injection.node = p.anatomy->centreline.nearest(p.wire->tip());
        advance(*p.contrast, *p.contrast_state, injection, dt);
    }
}

}  // namespace cathlab
