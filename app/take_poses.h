// A world as it stands -> what of it moves in a picture, and what in it stands still.
#pragma once

#include "anatomy/model.h"
#include "beam/exposure.h"
#include "core/parallel.h"
#include "record/poses.h"
#include "world/world.h"

namespace cathlab {

/// What is the same in all pictures of a run.
struct FrameStage {
    const AnatomyModel* anatomy = nullptr;
    const BeamSpec* beam = nullptr;
    const Workers* workers = nullptr;
};
FrameStage stage_of(World& world);

/// What poses.bin of a run on this stage must fit.
PosesFrame poses_frame(const AnatomyModel& anatomy);

/// Give the same object again and again: its vectors keep their memory.
void take_poses(World& world, ScenePoses& out);

}  // namespace cathlab
