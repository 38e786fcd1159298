// Thin devices as exact chords: a wire of 0.4 mm is one pixel wide, and no polygon tube of bearable size is round
// enough.
#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "render/frame_description.h"
#include "render/projection.h"

namespace cathlab {

/// One round piece of a chain: the cylinder around the segment a-b, cut at each end by a plane, or closed by a half
/// ball. At a joint the plane bisects its two pieces, so that neither gap nor overlap darkens it.
struct ChordPiece {
    Vec3 a, b;                    ///< ends, mm
    Vec3 plane_a, plane_b;        ///< unit normals of the end planes, pointing out of the piece
    double radius = 0, bore = 0;  ///< mm; bore = 0: solid
    bool ball_a = false, ball_b = false;
    std::uint8_t medium = 0;  ///< 0..15: where its length is added
};

/// Pieces of a device, end planes from its neighbours; free ends are half balls (flat where there is a bore).
/// Pieces shorter than 1e-6 mm are left out.  medium_of maps the device's material index to a medium.
void append_pieces(const FrameDevice& device, const std::vector<std::uint8_t>& medium_of, std::vector<ChordPiece>& out);

/// Length in mm of the line origin + t * direction (t in R, |direction| = 1) inside the piece (the bore not counted).
double chord(const ChordPiece& piece, const Vec3& origin, const Vec3& direction);

/// Path lengths of all pieces, only where there are some.
struct DeviceLengths {
    int media = 0;
    std::vector<std::uint32_t> pixel;  ///< y * width + x, ascending
    std::vector<float> length_mm;      ///< (pixels x media) mean over the pixel's area
};

/// Thin pieces take samples x samples rays a pixel, pieces over some pixels wide at most 2 x 2.
/// Rows are shared out among the workers; each pixel sums its pieces in their order, so the bits do not depend on
/// threads.
void draw_devices(const std::vector<ChordPiece>& pieces, int media, const Projection& projection, int samples,
                  const Workers& workers, DeviceLengths& out);

}  // namespace cathlab
