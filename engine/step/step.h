// One step of the world: the only function that changes a state.
#pragma once

#include "core/channels.h"
#include "core/input.h"
#include "world/world.h"

namespace cathlab {

/// Adds what the step keeps for itself to a world that a scene has filled (scratch, contacts, supports, the catheter's
/// shape): once, before the first step and before the first state hash.  Calling it again changes nothing. Expects
/// StepSettings and, on the vessel, Shared<AnatomyModel>, Shared<SoftBodyModel>, Shared<LumenSurfaceModel> and
/// SoftBodyState; throws std::logic_error otherwise.
void prepare(World& world);

/// Advances the world by one step of StepSettings::dt under `input` and writes every channel.
/// Pure: no clock, no globals; the result depends on world and input alone, on any number of threads.
/// Inputs that are not finite or out of range are clamped and leave an event.
void step(World& world, const Input& input, Channels& channels);

}  // namespace cathlab
