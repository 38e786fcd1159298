// The smallest world in which an effect acts on what a data set measures: the effect's own code runs, not a copy of it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "explain/dataset.h"

namespace cathlab {

/// Why this program cannot try the effect on this data, in a sentence; nothing where it can.
///   heart-motion: effects that use the hooks `drive` and `measure` only.  The rig is one held particle at the sensor:
///   what the drive does to a support and to the heart is added to the measured coordinates (along the axis where one
///   coordinate was measured; (0, 0, 1) where the data names no axis).
std::optional<std::string> why_not_tried(const EffectInfo& effect, const Dataset& data);

/// What the effect adds to each measured column, (columns x rows), with these parameter values.
std::vector<std::vector<double>> effect_on_rig(const EffectInfo& effect, std::span<const double> values,
                                               const Dataset& data);

/// Which of the effect's parameters the rig can tell from one another: false = held at its default.
std::vector<bool> identifiable(const EffectInfo& effect, const Dataset& data);

}  // namespace cathlab
