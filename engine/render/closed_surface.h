// What X-rays may be sent through.
#pragma once

#include <string>

#include "core/mesh.h"
#include "render/frame_description.h"
#include "render/projection.h"

namespace cathlab {

/// An open surface has no inside: its shadow would be nonsense wherever a ray meets the hole.  Throws UserError with
/// the number of faulty edges and the place of the first, mm; `what` names the surface in it.
void require_closed(const TriMesh& mesh, const std::string& what);

/// Rays leave the source towards the detector: what reaches back to the source's plane has no shadow.  Throws UserError
/// with its name and by how much.  standing_too: solids that do not move as well, which are many vertices.
void require_before_source(const FrameDescription& frame, const Projection& projection, bool standing_too);

}  // namespace cathlab
