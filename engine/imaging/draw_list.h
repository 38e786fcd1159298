// Panels and overlays as plain data: the HUD fills it, the renderer or the window draws it, neither knows the other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace cathlab {

/// A corner of a triangle: pixels from the top left, texture coordinates in [0, 1], colour with straight alpha
/// (red in the lowest byte, alpha in the highest).
struct DrawVertex {
    float x, y;
    float u, v;
    std::uint32_t rgba;
};

/// A run of triangles under one clip rectangle (pixels; x0 <= x < x1, y0 <= y < y1).
struct DrawCommand {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// The one texture: coverage of glyphs and of the white pixel.  Const after it is built, shared by all frames.
struct DrawAtlas {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> alpha;  ///< (height x width), rows from the top
};

/// Triangles in the order in which they are painted over a picture of width x height pixels.
struct HudDrawList {
    float width = 0;
    float height = 0;
    std::vector<DrawVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<DrawCommand> commands;
    std::shared_ptr<const DrawAtlas> atlas;

    bool empty() const { return commands.empty(); }
};

}  // namespace cathlab
