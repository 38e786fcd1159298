#include "step/wall_slip.h"

#include <cmath>

namespace cathlab {

void let_slip(Parts& p, const EffectContext& context, std::span<Vec3> support_displacement) {
    std::vector<Effect*> effects;
    p.each_effect(hook_slip, [&](Effect& effect) { effects.push_back(&effect); });
    if (effects.empty()) return;
    const SoftBodyModel& wall = *p.wall;
    const Entity vessel = p.world->owner<SupportState>();
    if (!p.world->get<SlipState>(vessel)) p.world->add(vessel, SlipState{std::vector<Vec3>(wall.size(), Vec3::Zero())});
    std::vector<Vec3>& slipped = p.world->get<SlipState>(vessel)->slipped_mm;
    SoftBodyScratch& scratch = *p.wall_scratch;
    const bool known = scratch.goal.size() == wall.size();  // a substep has been done
    // The last pass left goals for where the wall stood before it, and only round devices: k (g - x) is what the wall
    // pulls with where g belongs to x.
    if (known) solve_goals(wall, *p.wall_state, scratch, p.world->workers());
    for (std::size_t i = 0; i < wall.size(); ++i) {
        if (!wall.fixed[i]) continue;
        if (known) {
            const double k = wall.form == WallForm::elastic ? scratch.hold[i] : wall.stiffness[i];
            const double section = wall.thickness_mm[i] * std::sqrt(wall.area_mm2[i]);
            HeldPoint held;
            held.index = i;
            held.traction = k / section * (scratch.goal[i] - p.wall_state->x[i]);
            HeldPoint more = held;
            constexpr double part = 0.01;
            more.traction *= 1.0 + part;
            for (Effect* effect : effects) {
                effect->slip(context, held);
                effect->slip(context, more);
            }
            const double pull = part * held.traction.norm();
            const double gain = pull > 0.0 ? (more.slipped - held.slipped).norm() / pull : 0.0;  // mm/kPa
            slipped[i] += (held.slipped - slipped[i]) / (1.0 + gain * k / section);
            for (Effect* effect : effects) effect->remember_slip(context, held);
        }
        support_displacement[i] += slipped[i];
    }
}

}  // namespace cathlab
