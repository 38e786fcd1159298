#include "explain/rig.h"

#include <algorithm>
#include <cmath>

namespace cathlab {
namespace {

Vec3 axis_of(const Dataset& data) {
    return data.heart.axis.value_or(Vec3::UnitZ());
}

}  // namespace

std::optional<std::string> why_not_tried(const EffectInfo& effect, const Dataset& data) {
    if (data.kind != "heart-motion") return "there is no rig yet for data of kind '" + data.kind + "'";
    if ((effect.hooks & ~(hook_drive | hook_measure)) != 0)
        return "the rig of heart-motion has no wall for the hooks of '" + std::string(effect.name) + "' to act on";
    return std::nullopt;
}

std::vector<std::vector<double>> effect_on_rig(const EffectInfo& effect, std::span<const double> values,
                                               const Dataset& data) {
    const auto measured = data.of_role(ColumnRole::measured);
    const std::unique_ptr<Effect> made = effect.make(values);
    const Vec3 axis = axis_of(data);
    const std::vector<Vec3> sensor{Vec3::Zero()};
    const std::vector<double> mass{1e-6};
    const std::vector<std::uint8_t> held{1};
    std::vector<std::vector<double>> out(measured.size(), std::vector<double>(data.rows(), 0.0));
    Drive drive;
    for (std::size_t i = 0; i < data.rows(); ++i) {
        EffectContext context;
        context.dt = 0.02;
        context.time_s = data.time_s[i] - context.dt;  // drive() looks at the end of the step
        context.step = static_cast<std::int64_t>(i);
        context.wall_rest = context.wall_position = sensor;
        context.wall_mass = mass;
        context.wall_fixed = held;
        drive.support_displacement.assign(1, Vec3::Zero());
        drive.heart_displacement_mm = 0.0;
        if ((effect.hooks & hook_drive) != 0) made->drive(context, drive);
        const Vec3 moved = drive.support_displacement[0] + drive.heart_displacement_mm * axis;
        Channels channels;
        channels.annulus_displacement_mm = moved.dot(axis);
        if ((effect.hooks & hook_measure) != 0) made->measure(context, channels);
        const Vec3 seen = moved + (channels.annulus_displacement_mm - moved.dot(axis)) * axis;
        for (std::size_t c = 0; c < measured.size(); ++c) {
            const std::string& quantity = measured[c]->quantity;
            out[c][i] = quantity == "displacement" ? seen.dot(axis) : seen[quantity[0] - 'x'];
        }
    }
    return out;
}

std::vector<bool> identifiable(const EffectInfo& effect, const Dataset& data) {
    std::vector<double> values;
    for (const Parameter& p : effect.parameters) values.push_back(p.default_value);
    const auto usual = effect_on_rig(effect, values, data);
    std::vector<bool> out;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Parameter& p = effect.parameters[k];
        bool matters = false;
        // A parameter that changes nothing at two other places of its range has nothing to say here.
        for (const double part : {0.13, 0.71}) {
            std::vector<double> other = values;
            other[k] = p.default_value + part * ((part < 0.5 ? p.minimum : p.maximum) - p.default_value);
            matters = matters || effect_on_rig(effect, other, data) != usual;
        }
        out.push_back(matters);
    }
    return out;
}

}  // namespace cathlab
