// The labels of a film, picture by picture, as COCO (`--labels coco`).
#pragma once

#include <memory>
#include <string>

#include "core/channels.h"
#include "render/frame_description.h"
#include "scene/scene_spec.h"
#include "take_poses.h"

namespace cathlab {

/// Each picture gets masks of the devices and of the regions in it, the devices' middle lines in pixels and mm, key
/// points, camera, C-arm and every channel.  A picture that is held while the beam is off keeps the labels of the
/// picture that it shows; before the first exposure there are none.
class LabelRecorder {
public:
    /// film: what the pictures' file_name says; poses: whose devices those of all pictures are.  Throws UserError where
    /// the file cannot be written; so do the others.
    LabelRecorder(const std::string& path, const std::string& film, const FrameStage& stage, const ScenePoses& poses);
    ~LabelRecorder();

    /// The picture of this description, whose size and index are set.
    void add(const FrameStage& stage, const ScenePoses& poses, const SceneSpec& scene, const Channels& channels,
             const FrameDescription& frame);
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
