#include "step/step.h"

#include <algorithm>
#include <cmath>

#include "step/actuation.h"
#include "step/measure.h"
#include "step/parts.h"
#include "step/substep.h"
#include "step/wall_slip.h"

namespace cathlab {
namespace {

// What in_range changes leaves an event.
Input clamped(const Parts& p, const Input& wanted) {
    const Input input = in_range(wanted);
    for (const ActionInfo& action : action_table())
        if (input.*action.value != wanted.*action.value)
            p.event("clamped", world_entity, "action '" + std::string(action.name) + "' was out of its range",
                    input.*action.value);
    return input;
}

}  // namespace

void step(World& world, const Input& wanted, Channels& channels) {
    prepare(world);
    Parts parts = find_parts(world);
    const StepSettings& settings = *parts.settings;
    const double t0 = world.time_s;
    const EffectContext context = effect_context(parts, t0, settings.dt);

    // [effects: input]  between the operator's command and the device
    parts.stage("effects");
    Input input = wanted;
    parts.each_effect(hook_input, [&](Effect& effect) { effect.input(context, input); });
    input = clamped(parts, input);
    // [effects: actuation]  what drive, cables and shaft make of it
    SegmentBends bends;
    if (parts.catheter) bends = commanded_bends(*parts.catheter, input);
    actuate(parts, context, input, bends);

    // [effects: drive]  where the supports and the heart go
    Drive drive;
    drive.support_displacement.assign(parts.wall->size(), Vec3::Zero());
    parts.each_effect(hook_drive, [&](Effect& effect) { effect.drive(context, drive); });
    let_slip(parts, context, drive.support_displacement);
    const std::vector<Vec3> before = parts.supports->displacement;
    if (parts.wall->support.empty() && parts.wall_scratch->support.empty())
        for (std::size_t i = 0; i < parts.wall->size(); ++i)
            if (!parts.wall->fixed[i]) drive.support_displacement[i].setZero();
    parts.supports->displacement = drive.support_displacement;

    StepSums sums;
    const double h = settings.dt / static_cast<double>(settings.substeps);
    for (int k = 0; k < settings.substeps; ++k) {
        const double s1 = static_cast<double>(k + 1) / static_cast<double>(settings.substeps);
        substep(parts, input, bends, drive, before, parts.supports->displacement, s1, t0 + static_cast<double>(k) * h,
                h, sums);
    }

    ++world.step_index;
    world.time_s = static_cast<double>(world.step_index) * settings.dt;

    advance_imaging(parts, input, settings.dt);
    measure(parts, input, sums, channels);
    // [effects: measure]  what a sensor would read
    parts.stage("effects");
    parts.each_effect(hook_measure, [&](Effect& effect) { effect.measure(context, channels); });
    parts.stage("");
}

}  // namespace cathlab
