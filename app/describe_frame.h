// What moves in a picture, and the step's channels -> what the renderer draws, be it from a world that is stepped or
// from a run's poses.bin.  The one place that knows both sides.
#pragma once

#include <vector>

#include "contrast/along.h"
#include "core/channels.h"
#include "render/frame_description.h"
#include "scene/scene_spec.h"
#include "take_poses.h"
#include "view_change.h"

namespace cathlab {

/// What is the same in all frames of a run and takes a while to find.
struct FrameMemory {
    std::vector<AlongVessel> along;  ///< of each vertex of the lumen at rest
};

/// Fills everything but size, seed, frame_index and overlay.  Give the same objects for every frame of a run: meshes
/// are copied once and the camera turns with the device's tip from where it looked last.
/// `change`: what the view is to be instead of the run's own.  Throws UserError where that geometry cannot be.
void describe_frame(const FrameStage& stage, const ScenePoses& poses, const SceneSpec& scene, const Channels& channels,
                    const ViewChange& change, FrameMemory& memory, FrameDescription& frame);

}  // namespace cathlab
