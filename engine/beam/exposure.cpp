#include "beam/exposure.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/deterministic_math.h"
#include "core/range.h"

namespace cathlab {
namespace {

FineSpectrum spectrum_at(const BeamSpec& spec, double kvp) {
    return fine_spectrum({kvp, spec.aluminium_mm, spec.copper_mm, spec.caesium_iodide_mm}, TableReading::straight);
}

constexpr double smallest_opening = 0.1;  // share of the field

double towards(double now, double target, double most) {
    return std::isfinite(target) ? now + std::clamp(target - now, -most, most) : now;
}

}  // namespace

void validate(const BeamSpec& spec, const SourcePlace& where) {
    validate(spec.c_arm, where);
    if (spec.pulses_per_s != 7.5 && spec.pulses_per_s != 15.0 && spec.pulses_per_s != 30.0) {
        SourcePlace place = where;
        place.key = "pulses_per_s";
        std::ostringstream text;
        text << "found " << spec.pulses_per_s << ", allowed is 7.5, 15 or 30";
        throw UserError(place, text.str());
    }
    require_range(where, "primary_deg", spec.primary_deg, -180.0, 180.0);
    require_range(where, "secondary_deg", spec.secondary_deg, -90.0, 90.0);
    require_range(where, "target_kerma_ngy", spec.target_kerma_ngy, 1.0, 10000.0);
    require_range(where, "cine_kerma_ngy", spec.cine_kerma_ngy, 1.0, 10000.0);
    require_range(where, "dsa_kerma_ngy", spec.dsa_kerma_ngy, 1.0, 10000.0);
    require_range(where, "dsa_pulses_per_s", spec.dsa_pulses_per_s, 0.5, 30.0);
    require_range(where, "lag_s", spec.lag_s, 0.0, 10.0);
    require_range(where, "aluminium_mm", spec.aluminium_mm, 1.0, 20.0);
    require_range(where, "copper_mm", spec.copper_mm, 0.0, 2.0);
    require_range(where, "caesium_iodide_mm", spec.caesium_iodide_mm, 0.1, 2.0);
    require_range(where, "kvp_min", spec.kvp_min, 40.0, 150.0);
    require_range(where, "kvp_max", spec.kvp_max, spec.kvp_min, 150.0);
    require_range(where, "kvp_at_20_cm", spec.kvp_at_20_cm, 40.0, 150.0);
    require_range(where, "kvp_per_cm", spec.kvp_per_cm, 0.0, 20.0);
    require_range(where, "mas_max", spec.mas_max, 0.01, 1000.0);
    require_range(where, "mas_max_acquired", spec.mas_max_acquired, 0.01, 1000.0);
    require_range(where, "collimator_share_s", spec.collimator_share_s, 0.01, 100.0);
    require_range(where, "tube_output_ugy_mas", spec.tube_output_ugy_mas, 1.0, 1000.0);
    require_range(where, "grid_transmission", spec.grid_transmission, 0.05, 1.0);
    require_range(where, "reference_point_mm", spec.reference_point_mm, 0.0, spec.c_arm.sod_mm - 50.0);
    require_range(where, "kerma_rate_limit_mgy_min", spec.kerma_rate_limit_mgy_min, 0.1, 1000.0);
}

void visit(Archive& archive, BeamState& state) {
    archive.field("primary_deg", state.primary_deg);
    archive.field("secondary_deg", state.secondary_deg);
    archive.field("table_longitudinal_mm", state.table_longitudinal_mm);
    archive.field("table_lateral_mm", state.table_lateral_mm);
    archive.field("pedal", state.pedal);
    archive.field("water_mm", state.water_mm);
    archive.field("kvp", state.kvp);
    archive.field("mas", state.mas);
    archive.field("detector_kerma_ngy", state.detector_kerma_ngy);
    archive.field("air_kerma_mgy", state.air_kerma_mgy);
    archive.field("kerma_rate_mgy_min", state.kerma_rate_mgy_min);
    archive.field("dose_area_gycm2", state.dose_area_gycm2);
    archive.field("beam_time_s", state.beam_time_s);
    archive.field("frames", state.frames);
    // What was never used is no part of the state: a run that does without has the bits of one that never heard of it.
    std::int64_t acquisition = static_cast<std::int64_t>(state.acquisition),
                 level = static_cast<std::int64_t>(state.level);
    if (state.acquisition != Acquisition::fluoroscopy) archive.field("acquisition", acquisition);
    if (state.level != FluoroscopyLevel::normal) archive.field("level", level);
    if (state.collimator_width != 1.0) archive.field("collimator_width", state.collimator_width);
    if (state.collimator_height != 1.0) archive.field("collimator_height", state.collimator_height);
    if (state.roadmap) archive.field("roadmap", state.roadmap);
    if (state.references != 0) archive.field("references", state.references);
}

BeamState initial_state(const BeamSpec& spec) {
    BeamState state;
    state.primary_deg = spec.primary_deg;
    state.secondary_deg = spec.secondary_deg;
    state.kvp = expose(spec, state.water_mm, state.water_mm).kvp;
    return state;
}

bool pulse_in_step(std::int64_t step, double dt, double pulses_per_s) {
    // The small shift keeps a pulse that falls exactly on a step's end (rounded a hair below it) in that step.
    const auto pulses_by = [&](std::int64_t s) {
        return std::floor(static_cast<double>(s) * dt * pulses_per_s + 1e-9);
    };
    return pulses_by(step + 1) > pulses_by(step);
}

double tube_output_ugy_mas(const BeamSpec& spec, double kvp) {
    // Per mAs a thick anode gives photons(E) ~ kvp / E - 1 for any voltage, so the outputs compare as those integrals
    // do.
    const FineSpectrum reference = fine_spectrum({80.0, 2.5, 0.0, spec.caesium_iodide_mm}, TableReading::straight);
    const FineSpectrum filtered = spectrum_at(spec, kvp);
    return spec.tube_output_ugy_mas * filtered.total * filtered.kerma_per_photon /
           (reference.total * reference.kerma_per_photon);
}

Technique technique_of(const BeamSpec& spec, const BeamState& state) {
    Technique out;
    out.open_share = state.collimator_width * state.collimator_height;
    out.pulses_per_s = spec.pulses_per_s;
    if (state.acquisition == Acquisition::fluoroscopy) {
        const double share = state.level == FluoroscopyLevel::low    ? 0.5
                             : state.level == FluoroscopyLevel::high ? 2.0
                                                                     : 1.0;
        out.kerma_ngy = share * spec.target_kerma_ngy;
        out.mas_max = spec.mas_max;
        return out;
    }
    out.mas_max = spec.mas_max_acquired;
    out.rate_limited = false;
    out.kerma_ngy = spec.cine_kerma_ngy;
    if (state.acquisition == Acquisition::dsa) {
        out.kerma_ngy = spec.dsa_kerma_ngy;
        out.pulses_per_s = std::min(spec.pulses_per_s, spec.dsa_pulses_per_s);
    }
    return out;
}

Pulse expose(const BeamSpec& spec, double set_water_mm, double true_water_mm) {
    return expose(spec, set_water_mm, true_water_mm,
                  {spec.target_kerma_ngy, spec.pulses_per_s, spec.mas_max, true, 1.0});
}

Pulse expose(const BeamSpec& spec, double set_water_mm, double true_water_mm, const Technique& technique) {
    Pulse pulse;
    pulse.kvp =
        std::clamp(spec.kvp_at_20_cm + spec.kvp_per_cm * (0.1 * set_water_mm - 20.0), spec.kvp_min, spec.kvp_max);
    const FineSpectrum spectrum = spectrum_at(spec, pulse.kvp);
    const double output = tube_output_ugy_mas(spec, pulse.kvp);  // uGy per mAs at 1 m
    const double to_detector = 1e6 / (spec.c_arm.sid_mm * spec.c_arm.sid_mm) * spec.grid_transmission;
    const double reference_mm = spec.c_arm.sod_mm - spec.reference_point_mm;
    const double to_reference = 1e6 / (reference_mm * reference_mm);
    const double wanted =
        1e-3 * technique.kerma_ngy / (output * to_detector * kerma_transmission(spectrum, set_water_mm));
    pulse.mas = std::min(wanted, technique.mas_max);
    if (technique.rate_limited) {
        const double mgy_per_pulse_limit = spec.kerma_rate_limit_mgy_min / (60.0 * technique.pulses_per_s);
        pulse.mas = std::min(pulse.mas, 1e3 * mgy_per_pulse_limit / (output * to_reference));
    }
    pulse.detector_kerma_ngy = 1e3 * output * pulse.mas * to_detector * kerma_transmission(spectrum, true_water_mm);
    pulse.reference_kerma_mgy = 1e-3 * output * pulse.mas * to_reference;
    const double side_cm = 0.1 * spec.c_arm.field_mm * reference_mm / spec.c_arm.sid_mm;
    const double aspect = static_cast<double>(spec.c_arm.rows) / static_cast<double>(spec.c_arm.columns);
    pulse.dose_area_gycm2 = 1e-3 * pulse.reference_kerma_mgy * side_cm * side_cm * aspect * technique.open_share;
    return pulse;
}

Vec3 isocentre_in_patient(const BeamSpec& spec, double table_longitudinal_mm, double table_lateral_mm) {
    return spec.isocentre + Vec3(table_lateral_mm, 0.0, table_longitudinal_mm);
}

bool advance(const BeamSpec& spec, BeamState& state, const BeamCommand& command, double water_mm, std::int64_t step,
             double dt) {
    const double turn = spec.c_arm.rotation_deg_s * dt;
    state.primary_deg = towards(state.primary_deg, std::clamp(command.primary_deg, -180.0, 180.0), turn);
    state.secondary_deg = towards(state.secondary_deg, std::clamp(command.secondary_deg, -90.0, 90.0), turn);
    const double way = spec.table_mm_s * dt;
    state.table_longitudinal_mm = towards(state.table_longitudinal_mm, command.table_longitudinal_mm, way);
    state.table_lateral_mm = towards(state.table_lateral_mm, command.table_lateral_mm, way);
    const double opening = spec.collimator_share_s * dt;
    const auto blades = [&](double now, double wanted) {
        return std::clamp(towards(now, std::clamp(wanted, smallest_opening, 1.0), opening), smallest_opening, 1.0);
    };
    state.collimator_width = blades(state.collimator_width, command.collimator_width);
    state.collimator_height = blades(state.collimator_height, command.collimator_height);
    if (command.reference && !state.reference_key) ++state.references;
    state.reference_key = command.reference;
    state.roadmap = command.roadmap;
    if (command.pedal && (!state.pedal || command.acquisition != state.acquisition)) ++state.series;
    state.acquisition = command.acquisition;
    state.level = command.level;
    state.pedal = command.pedal;
    if (!command.pedal) {
        state.kerma_rate_mgy_min = 0.0;
        return false;
    }

    const double truth = std::isfinite(water_mm) ? std::clamp(water_mm, 0.0, 600.0) : state.water_mm;
    const double kept = spec.lag_s > 0.0 ? det::exp(-dt / spec.lag_s) : 0.0;
    state.water_mm = truth + kept * (state.water_mm - truth);
    state.beam_time_s += dt;
    const Technique technique = technique_of(spec, state);
    if (!pulse_in_step(step, dt, technique.pulses_per_s)) return false;
    const Pulse pulse = expose(spec, state.water_mm, truth, technique);
    state.kvp = pulse.kvp;
    state.mas = pulse.mas;
    state.kerma_rate_mgy_min = 60.0 * technique.pulses_per_s * pulse.reference_kerma_mgy;
    state.detector_kerma_ngy = pulse.detector_kerma_ngy;
    state.air_kerma_mgy += pulse.reference_kerma_mgy;
    state.dose_area_gycm2 += pulse.dose_area_gycm2;
    ++state.frames;
    return true;
}

}  // namespace cathlab
