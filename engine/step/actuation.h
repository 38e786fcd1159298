// Effects between the catheter's drive and its shape.
#pragma once

#include "core/archive.h"
#include "core/input.h"
#include "step/parts.h"

namespace cathlab {

/// Component of the catheter in a world with an effect that uses the hook `actuation`: sums of what was commanded and
/// of what came of it.
struct CatheterTravel {
    double commanded_mm = 0.0, commanded_rad = 0.0;
    double taken_mm = 0.0, taken_rad = 0.0;
};
inline void visit(Archive& archive, CatheterTravel& travel) {
    archive.field("commanded_mm", travel.commanded_mm);
    archive.field("commanded_rad", travel.commanded_rad);
    archive.field("taken_mm", travel.taken_mm);
    archive.field("taken_rad", travel.taken_rad);
}

/// What is asked of every segment of the catheter, base first.
struct SegmentBends {
    std::vector<double> bend_deg, direction_deg;
};

/// The operator's two bends, on the segments that follow them (CatheterSpec::driven_by); the others stay straight.
SegmentBends commanded_bends(const CatheterSpec& spec, const Input& input);

/// Gives the command to the effects that stand between drive and catheter, and changes it into what they leave of it.
/// Nothing happens in a world without one.
void actuate(Parts& parts, const EffectContext& context, Input& input, SegmentBends& bends);

}  // namespace cathlab
