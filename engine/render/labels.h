// What is where in a fluoroscopic picture, for those who train and test algorithms on it: masks, places, lines, camera.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "render/frame_description.h"

namespace cathlab {

/// What a description does not hold of itself.
struct LabelSource {
    std::vector<Index> region;              ///< (n) of each vertex of the lumen; empty: no masks of regions
    std::vector<std::string> region_names;  ///< by index
    struct Point {
        std::string name;
        Vec3 position = Vec3::Zero();  ///< mm, world
        bool seen = false;  ///< whether the picture shows it: a device's tip, or an ostium with contrast medium in it
    };
    std::vector<Point> points;
    double seen_mg_ml = 5.0;  ///< of iodine in a vessel before a picture shows it (an assumption)
};

/// Places are pixel coordinates of the picture: pixel (i, j) covers [i, i+1) x [j, j+1), 0 0 = its upper left corner.
struct FrameLabels {
    int width = 0, height = 0;
    /// One byte a pixel, 0 or 1, rows from the top.  Of regions only those that are in the picture.
    struct Mask {
        std::string name;
        std::vector<std::uint8_t> inside;  ///< the whole silhouette, whatever lies before or behind it (amodal)
        /// What of it the picture shows (modal), part of `inside` and of the collimator's field.  X-rays pass, so what
        /// lies before does not hide; of two devices a pixel belongs to the one with the deeper shadow.  A vessel is to
        /// be seen where medium is in it, and no device.
        std::vector<std::uint8_t> visible;
    };
    std::vector<Mask> devices, regions;
    struct Point {
        std::string name;
        Vec3 world = Vec3::Zero();
        Vec2 pixel = Vec2::Zero();
        int visibility = 0;  ///< COCO's: 0 outside the picture, 1 in it but not to be seen, 2 seen
    };
    std::vector<Point> points;
    struct Line {
        std::string name;
        std::vector<Vec3> world;   ///< tip first, mm
        std::vector<Vec2> pixels;  ///< the same; those outside the picture too
    };
    std::vector<Line> lines;  ///< one a device
    /// Row-major 3 x 4: (x, y, z, 1) in mm -> w (column, row, 1).  A pinhole; an image intensifier bends what it gives.
    std::array<double, 12> camera{};
};

/// The same geometry as the picture of that size, an image intensifier's distortion and round field included.
/// Throws UserError where the geometry cannot be.
FrameLabels label_frame(const FrameDescription& frame, const LabelSource& source, int width, int height,
                        const Workers& workers);

}  // namespace cathlab
