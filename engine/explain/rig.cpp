#include "explain/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "explain/residual.h"
#include "explain/rigs.h"

namespace cathlab {
namespace {

// The particle that stands for the device's or the sensor's support.  Its height is one at which a breath acts in full.
const std::array<Vec3, 1> support_place{Vec3::Zero()};
const std::array<double, 1> support_mass{1e-6};
const std::array<std::uint8_t, 1> support_held{1};

/// Counts what a state holds.
class Count final : public Archive {
public:
    std::size_t found = 0;

private:
    void numbers(std::string_view, double*, std::size_t size) override { found += size; }
    void numbers(std::string_view, float*, std::size_t size) override { found += size; }
    void numbers(std::string_view, std::int64_t*, std::size_t size) override { found += size; }
};

}  // namespace

std::size_t phase_place(const EffectInfo& effect) {
    const auto it = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                 [](const Parameter& p) { return p.key == "phase"; });
    return static_cast<std::size_t>(it - effect.parameters.begin());
}

RigEffects::RigEffects(std::span<const EffectTrial> trials) : trials_(trials) {
    context_.wall_rest = support_place;
    context_.wall_position = support_place;
    context_.wall_mass = support_mass;
    context_.wall_fixed = support_held;
}

void RigEffects::begin_run(Index run) {
    made_.clear();
    for (const EffectTrial& trial : trials_) {
        std::vector<double> values = trial.own.empty() ? trial.values : trial.own[static_cast<std::size_t>(run)];
        if (trial.phase_of_run.empty()) {
            made_.push_back(trial.effect->make(values));
            continue;
        }
        double& phase = values[phase_place(*trial.effect)];
        phase += trial.phase_of_run[static_cast<std::size_t>(run)];
        phase -= std::floor(phase);
        made_.push_back(trial.effect->make(values));
    }
    of_membrane_.clear();
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_membrane) != 0) of_membrane_.push_back(made_[k].get());
    context_.step = -1;
    first_ = true;
}

void RigEffects::next_row(double time_s) {
    context_.dt = first_ ? 0.0 : time_s - last_s_;
    context_.time_s = time_s - context_.dt;
    ++context_.step;
    first_ = false;
    last_s_ = time_s;
}

void RigEffects::actuation(Actuation& act) {
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_actuation) != 0) made_[k]->actuation(context_, act);
}

const Drive& RigEffects::drive() {
    drive_.support_displacement.assign(1, Vec3::Zero());
    drive_.heart_rate_scale = drive_.heart_amplitude_scale = 1.0;
    drive_.heart_displacement_mm = 0.0;
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_drive) != 0) made_[k]->drive(context_, drive_);
    return drive_;
}

void RigEffects::measure(Channels& channels) {
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_measure) != 0) made_[k]->measure(context_, channels);
}

Vec3 RigEffects::read_tip(const Vec3& tip) {
    Channels channels;
    channels.catheter_tip_x_mm = tip.x();
    channels.catheter_tip_y_mm = tip.y();
    channels.catheter_tip_z_mm = tip.z();
    measure(channels);
    return {channels.catheter_tip_x_mm, channels.catheter_tip_y_mm, channels.catheter_tip_z_mm};
}

void RigEffects::points(std::size_t count) {
    for (Effect* effect : of_membrane_) effect->points(count);
}

Fibres RigEffects::fibres() {
    Fibres out;
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_material) != 0) made_[k]->fibres(context_, out);
    return out;
}

double RigEffects::surroundings() {
    double out = 0.0;
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_material) != 0) made_[k]->surroundings(context_, std::span(&out, 1));
    return out;
}

void RigEffects::membrane(const MembraneMaterial& material, const Fibres& fibres, MembranePoint& point) {
    ask_membrane(of_membrane_, context_, material, fibres, point);
}

void RigEffects::remember(const MembranePoint& point) {
    for (Effect* effect : of_membrane_) effect->remember(context_, point);
}

bool RigEffects::remembers() {
    Count count;
    for (Effect* effect : of_membrane_) effect->visit(count);
    return count.found > 0;
}

void RigEffects::slip(HeldPoint& held) {
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_slip) != 0) made_[k]->slip(context_, held);
}

void RigEffects::remember_slip(const HeldPoint& held) {
    for (std::size_t k = 0; k < made_.size(); ++k)
        if ((trials_[k].effect->hooks & hook_slip) != 0) made_[k]->remember_slip(context_, held);
}

bool RigEffects::uses(unsigned hooks) const {
    return std::any_of(trials_.begin(), trials_.end(),
                       [&](const EffectTrial& trial) { return (trial.effect->hooks & hooks) != 0; });
}

Rig::Rig(const Dataset& data, const Split& split)
    : data_(data), split_(split), measured_(data.of_role(ColumnRole::measured)) {
    for (const DataColumn* column : measured_) {
        const auto known = [&](std::uint8_t part) {
            for (std::size_t i = 0; i < data.rows(); ++i)
                if (split.held_out[i] == part && !std::isnan(column->values[i])) return true;
            return false;
        };
        if (!known(0)) throw UserError(data.folder + ": the rows to be fitted hold no '" + column->name + "'");
        if (!known(1)) throw UserError(data.folder + ": the rows that are held out hold no '" + column->name + "'");
    }
}

std::string Rig::why_not(const EffectInfo& effect) const {
    if ((effect.hooks & ~hooks_) != 0)
        return "the rig of " + data_.kind + " has nothing for the hooks of '" + spoken_name(effect) + "' to act on";
    return "";
}

std::unique_ptr<Rig> make_rig(const Dataset& data, const Split& split, const Crew& crew) {
    // Every candidate runs through all rows hundreds of times.
    constexpr std::size_t most_rows = 100000;
    if (data.rows() > most_rows)
        throw UserError(data.folder + ": has " + std::to_string(data.rows()) + " rows; at most " +
                        std::to_string(most_rows) +
                        " can be explained in reasonable time: leave out recordings, or rows at even distances");
    if (data.kind == "catheter-tip") return make_catheter_rig(data, split);
    if (data.kind == "tendon-tip") return make_tendon_rig(data, split);
    if (data.kind == "heart-motion") return make_heart_rig(data, split);
    if (data.kind == "wall-tension") return make_tension_rig(data, split);
    if (data.kind == "wall-contact") return make_contact_rig(data, split, crew);
    throw UserError(data.folder + ": data of kind '" + data.kind + "' have no rig");
}

double rms_of(const Columns& residual, const Split& split, std::uint8_t part) {
    const std::size_t count = split.judged > 0 ? std::min(split.judged, residual.size()) : residual.size();
    double sum = 0.0;
    for (std::size_t c = 0; c < count; ++c) {
        const double r = rms(residual[c], split.held_out, part);
        if (!std::isnan(r)) sum += r * r;
    }
    return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace cathlab
