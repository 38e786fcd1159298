// A world as it stands -> what the renderer draws.  The one place that knows both sides.
#pragma once

#include "core/channels.h"
#include "render/frame_description.h"
#include "scene/scene_spec.h"
#include "world/world.h"

namespace cathlab {

/// Fills everything but size, seed, frame_index and overlay.  Give the same object for every frame of a run: meshes are
/// copied once and the camera turns with the device's tip from where it looked last.
void describe_frame(World& world, const SceneSpec& scene, const Channels& channels, FrameDescription& frame);

}  // namespace cathlab
