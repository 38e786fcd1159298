// The L-buffer on the processor, on any number of threads: what GL's software rasteriser spends on setting up a
// triangle of a few pixels (the lumen has thousands, and they move in every frame) is several times what the triangle
// costs.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/parallel.h"
#include "render/path_lengths.h"
#include "render/pixel_loops.h"

namespace cathlab {

/// Scan conversion of the surface as the source sees it: every pixel's centre adds the distance where its ray leaves
/// the surface and takes off that where it enters [freud2006], into float32.  The distance is that to the triangle's
/// plane, exactly: 1 / depth is linear over the picture.  In each row an edge begins at one pixel, the same for both of
/// its triangles, and counts with the direction in which each runs through it: on a closed surface these cancel, so
/// that every ray has as many entries as exits whatever is rounded.
/// Bands of rows are drawn beside one another, each with its triangles in their order: the sums have the same bits on
/// any number of threads.
class PathRaster {
public:
    explicit PathRaster(Workers workers = Workers()) : workers_(std::move(workers)) {}

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
    struct Crossing {
        float depth, value, width, exit;  // exit: 1 leaving, -1 entering
    };
    // What a band of rows needs while it is drawn; kept for its memory.
    struct Band {
        int begin = 0, end = 0;    // rows
        std::vector<float> depth;  // a pixel: leaving - entering, along the detector's normal, less a reference
        std::vector<float> exits;  // a pixel: leaving - entering
        std::vector<std::pair<std::uint32_t, Crossing>> met;  // pixel and crossing, as the triangles come
        std::vector<Crossing> crossings;                      // of pixel i: first[i] to first[i + 1], by depth
        std::vector<std::uint32_t> first;
        std::size_t bad = 0;

        void sort_crossings();
        float integral(std::size_t pixel) const;
    };
    // What draw() was called with.
    struct Job {
        std::span<const Triangle> triangles;
        std::span<const double> values, widths;
        bool with_values = false;
    };

    void project(const Projection& projection, std::span<const Vec3> vertices);
    void sort_into_bands(std::span<const Triangle> triangles);
    template <bool with_values>
    void add(const Triangle& t, const Job& job, Band& band) const;
    void draw_band(std::size_t index, const Job& job, PathLengths& out);

    Workers workers_;
    const pixel_loops::Set* loops_ = &pixel_loops::best();
    std::vector<Corner> corners_;
    std::vector<double> slope_x_, slope_y_;  // of the ray through a column's (row's) centre: mm a mm of depth
    std::vector<Band> bands_;
    std::vector<std::vector<std::uint32_t>> touching_;  // [chunk of triangles x bands + band]: which, in their order
    std::size_t chunks_ = 0;
    double reference_ = 0.0;  // keeps the sums small
    int width_ = 0, height_ = 0;
    bool mirrored_ = false;
};

}  // namespace cathlab
