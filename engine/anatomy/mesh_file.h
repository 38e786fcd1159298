// Triangle meshes from files (OBJ, STL, PLY, GLB, glTF), by assimp.
#pragma once

#include <string>

#include "core/errors.h"
#include "core/mesh.h"

namespace cathlab {

/// Reads a file's triangles, scaled to mm ("mm", "cm" or "m"), vertices nearer than a millionth of the mesh's size
/// welded, triangles that shrink to an edge by that dropped.  Throws UserError: missing, unreadable, above 512 MB,
/// without triangles, with coordinates that are not finite.
TriMesh load_mesh(const std::string& path, const std::string& unit, const SourcePlace& where);

/// Throws UserError unless the mesh is closed and manifold (edges and vertices): names the fault, how many, where.
/// `unit_mm`: one unit of the file in mm, so that the place is told in the file's own coordinates.
void require_closed(const TriMesh& mesh, const std::string& path, double unit_mm, const SourcePlace& where);

/// Turns triangles so that neighbours agree and each component faces outward.  True where some had to be turned.
bool orient_outward(TriMesh& mesh);

double unit_in_mm(const std::string& unit);

}  // namespace cathlab
