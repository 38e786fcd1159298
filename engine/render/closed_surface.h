// What X-rays may be sent through.
#pragma once

#include <string>

#include "core/mesh.h"

namespace cathlab {

/// An open surface has no inside: its shadow would be nonsense wherever a ray meets the hole.  Throws UserError with
/// the number of faulty edges and the place of the first, mm; `what` names the surface in it.
void require_closed(const TriMesh& mesh, const std::string& what);

}  // namespace cathlab
