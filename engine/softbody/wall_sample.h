// The wall as particles: blue noise on a fine closed surface, each with the area that it stands for.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/types.h"

namespace cathlab {

/// Particles on the lumen surface.  They carry the wall's thickness as a number: it goes into mass and stiffness.
struct WallSample {
    std::vector<Vec3> position;        ///< (n) mm, vertices of the fine surface, in an order that keeps neighbours near
    std::vector<Vec3> normal;          ///< (n) unit, out of the lumen
    std::vector<double> area_mm2;      ///< (n) area of the Voronoi cell; they add up to the surface's area
    std::vector<double> thickness_mm;  ///< (n) of the wall there
    std::vector<Index> region;         ///< (n)
    std::vector<std::pair<Index, Index>> links;  ///< a < b, ascending: particles whose cells touch along the wall
    std::vector<Triangle> triangles;             ///< of particles, outward: where three cells meet
    std::vector<Vec3> along;                     ///< (n) the vessel's direction, any length; empty = not known
};

/// The spacing that puts at least eight particles round a lumen: min(wanted, 2 pi radius / 9.5).
/// wanted, radius: one a vertex of the fine surface, mm.
std::vector<double> lumen_spacing(std::span<const double> wanted, std::span<const double> radius);

/// Samples `fine` (triangles outward, edges well under the spacing) so that a particle stands for about spacing^2.
///   fine_region           (vertices) index of the region
///   spacing_of_vertex     (vertices) wanted distance, mm, > 0; where it changes, the finer one spreads with a slope of
///   0.3, so
///                         that a coronary of 1 mm begins in a zone of the aorta that is already fine
///   thickness_of_region   (regions) mm, > 0
/// Distances run along the mesh's edges: blue noise, then three rounds of Lloyd's relaxation, then Voronoi cells.
/// The same arguments give the same sample, bit for bit.
/// Throws UserError where a spacing or a thickness is not positive and finite, or the surface is empty.
WallSample sample_wall(const TriMesh& fine, const std::vector<Index>& fine_region,
                       std::span<const double> spacing_of_vertex, std::span<const double> thickness_of_region,
                       std::uint64_t seed);

}  // namespace cathlab
