// Where a point of the patient falls on the fluoroscopy.
#pragma once

#include <optional>

#include "core/types.h"
#include "render/frame_description.h"

namespace cathlab::play {

/// Shares of the picture's width and height from its top left; nothing for a point behind the source.  May lie outside
/// [0, 1].
std::optional<Vec2> place_on_picture(const CArmView& view, const Vec3& point);

}  // namespace cathlab::play
