// The L-buffer: how many mm of a closed surface's inside every ray passes, in float32 (Freud et al. 2006, Vidal et al.
// 2009).  Here by GL: the other way, beside which path_raster.h, which draws the pictures, is tested.
#pragma once

#include <memory>
#include <vector>

#include "core/types.h"
#include "imaging/image.h"
#include "render/projection.h"

namespace cathlab {

class GlDevice;

/// What one pass gives.
struct PathLengths {
    ImageF length_mm;            ///< inside the surfaces drawn; 0 at bad pixels
    ImageF contrast_mm_mg_ml;    ///< integral of the concentration along the ray; empty where no values were given
    std::size_t bad_pixels = 0;  ///< rays that enter and leave a different number of times: the surface is not closed
};

/// A set of closed surfaces kept on the GL side.
class PathSurface;

class PathLengthBuffer {
public:
    explicit PathLengthBuffer(std::shared_ptr<GlDevice> device);
    ~PathLengthBuffer();

    std::unique_ptr<PathSurface> make_surface() const;
    void set_triangles(PathSurface& surface, const std::vector<Triangle>& triangles) const;
    /// vertices: mm, world
    void set_vertices(PathSurface& surface, const std::vector<Vec3>& vertices) const;

    /// Draws the surfaces together.  Cost: one clear, one draw a surface, one read-back.
    void draw(const Projection& projection, const std::vector<const PathSurface*>& surfaces, PathLengths& out);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
