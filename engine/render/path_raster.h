// The L-buffer of one closed surface of very many small triangles that move in every frame: the lumen.  What GL's
// software rasteriser spends on setting up a triangle of a few pixels is several times what the triangle itself costs.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "render/path_lengths.h"

namespace cathlab {

/// Scan conversion of the surface as the source sees it: every pixel's centre adds the distance where its ray leaves
/// the surface and takes off that where it enters [freud2006], into float32.  The distance is that to the triangle's
/// plane, exactly: 1 / depth is linear over the picture.  In each row an edge begins at one pixel, the same for both of
/// its triangles, and counts with the direction in which each runs through it: on a closed surface these cancel, so
/// that every ray has as many entries as exits whatever is rounded.
class PathRaster {
public:
    /// vertices: mm, world, and wholly on the detector's side of the source; values: one a vertex, >= 0, to be
    /// integrated along the ray (between each entry and the exit after it, so that of two vessels behind one another
    /// each has its own), or empty; widths: one a vertex, > 0, or empty for alike.  Over a way s between an entry and
    /// an exit
    ///     integral = s (w1 c1 + w2 c2) / (w1 + w2),
    /// the trapezoid where both are as wide.  Where a narrow vessel opens into a wide one, a ray goes in through the
    /// wall of one and out through the other's, and most of its way is in the wide one.
    void draw(const Projection& projection, std::span<const Vec3> vertices, std::span<const Triangle> triangles,
              std::span<const double> values, PathLengths& out, std::span<const double> widths = {});

private:
    struct Corner {
        double x, y, z;      // mm along the detector's rows, its columns, and towards it, from the source
        double inverse;      // 1 / z
        double column, row;  // on the picture, whole at the pixels' centres
    };
    struct Sum {
        float depth = 0.0F;  // leaving - entering, along the detector's normal, less a reference
        float exits = 0.0F;  // leaving - entering
    };
    struct Crossing {
        float depth, value, width, exit;  // exit: 1 leaving, -1 entering
    };

    template <bool with_values>
    void add(const Triangle& t, std::span<const double> values, std::span<const double> widths);
    void project(const Projection& projection, std::span<const Vec3> vertices);
    void sort_crossings();
    float integral(std::size_t pixel) const;

    std::vector<Corner> corners_;
    std::vector<double> slope_x_, slope_y_;  // of the ray through a column's (row's) centre: mm a mm of depth
    std::vector<Sum> sums_;
    std::vector<std::pair<std::uint32_t, Crossing>> met_;  // pixel and crossing, as the triangles come
    std::vector<Crossing> crossings_;                      // of pixel i: first_[i] to first_[i + 1], by depth
    std::vector<std::uint32_t> first_;
    double reference_ = 0.0;  // keeps the sums small
    int width_ = 0, height_ = 0;
    bool mirrored_ = false;
};

}  // namespace cathlab
