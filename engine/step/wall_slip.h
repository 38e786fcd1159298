// What holds the wall gives way.
#pragma once

#include <span>

#include "step/parts.h"

namespace cathlab {

/// Component of the vessel in a world with an effect that uses the hook `slip`: how far each held particle has slipped.
struct SlipState {
    std::vector<Vec3> slipped_mm;  ///< (n)
};
inline void visit(Archive& archive, SlipState& state) {
    archive.field("slipped_mm", state.slipped_mm);
}

/// Asks the effects that use the hook `slip` how far held particles give way under what the wall pulled at them last,
/// and adds it to where their supports go.  Goes there as far as is stable: to the meeting of the slip's law and of a
/// spring as stiff as the particle is held in the wall.
void let_slip(Parts& parts, const EffectContext& context, std::span<Vec3> support_displacement);

}  // namespace cathlab
