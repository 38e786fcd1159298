#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/check.h"
#include "render/gl_device.h"
#include "shader_sources.h"

namespace cathlab {

namespace {

constexpr int tile_px = 16;

}  // namespace

struct Overlay::Impl {
    explicit Impl(GlDevicePtr d)
        : device(std::move(d)),
          program(device, shaders::overlay_vert, shaders::overlay_frag),
          mesh(device, {2, 2, 4}) {}
    ~Impl() {
        device->make_current();
        if (texture != 0) device->gl().DeleteTextures(1, &texture);
    }

    GlDevicePtr device;
    GlProgram program;
    GlMesh mesh;
    std::unique_ptr<GlFramebuffer> buffer;
    GLuint texture = 0;
    std::shared_ptr<const DrawAtlas> atlas;  // the one in the texture
    std::vector<float> vertices;
    std::vector<std::uint8_t> rgba;
    std::vector<std::uint8_t> painted;  // a tile of the picture: whether a triangle may have touched it

    void find_painted(const HudDrawList& list, int columns, int rows);
    void read_painted(int columns, int rows);
    void paint(int columns, Image8& picture) const;
    void use_atlas(const std::shared_ptr<const DrawAtlas>& wanted) {
        const GlTable& gl = device->gl();
        gl.ActiveTexture(GL_TEXTURE0);
        if (texture == 0) gl.GenTextures(1, &texture);
        gl.BindTexture(GL_TEXTURE_2D, texture);
        if (atlas == wanted) return;
        atlas = wanted;
        gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, atlas->width, atlas->height, 0, GL_RED, GL_UNSIGNED_BYTE,
                      atlas->alpha.data());
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    }
};

void Overlay::Impl::find_painted(const HudDrawList& list, int columns, int rows) {
    painted.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    const auto tile = [](float v, int count) {
        return std::clamp(static_cast<int>(std::floor(v / tile_px)), 0, count - 1);
    };
    for (std::size_t i = 0; i + 2 < list.indices.size(); i += 3) {
        const DrawVertex &a = list.vertices[list.indices[i]], &b = list.vertices[list.indices[i + 1]],
                         &c = list.vertices[list.indices[i + 2]];
        const int x0 = tile(std::min({a.x, b.x, c.x}), columns), x1 = tile(std::max({a.x, b.x, c.x}), columns);
        const int y0 = tile(std::min({a.y, b.y, c.y}), rows), y1 = tile(std::max({a.y, b.y, c.y}), rows);
        for (int y = y0; y <= y1; ++y) {
            const auto row = painted.begin() + static_cast<std::ptrdiff_t>(y) * columns;
            std::fill(row + x0, row + x1 + 1, std::uint8_t{1});
        }
    }
}

// The panels stand at the top and the bottom: the rows between stay where they are.
void Overlay::Impl::read_painted(int columns, int rows) {
    const auto touched = [&](int row) {
        const auto begin = painted.begin() + static_cast<std::ptrdiff_t>(row) * columns;
        return std::find(begin, begin + columns, std::uint8_t{1}) != begin + columns;
    };
    const auto row_bytes = static_cast<std::size_t>(buffer->width()) * 4;
    rgba.resize(row_bytes * static_cast<std::size_t>(buffer->height()));
    for (int from = 0; from < rows; ++from) {
        if (!touched(from)) continue;
        int to = from + 1;
        while (to < rows && touched(to)) ++to;
        const int first = from * tile_px, last = std::min(buffer->height(), to * tile_px);
        buffer->read_rows(first, last, GL_RGBA, GL_UNSIGNED_BYTE,
                          rgba.data() + row_bytes * static_cast<std::size_t>(first));
        from = to;
    }
}

// Over the picture, only where something was painted.
void Overlay::Impl::paint(int columns, Image8& picture) const {
    for (int y = 0; y < picture.height; ++y) {
        for (int column = 0; column < columns; ++column) {
            if (painted[static_cast<std::size_t>(y / tile_px) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(column)] == 0)
                continue;
            const int from = column * tile_px, to = std::min(picture.width, from + tile_px);
            std::uint8_t* below = picture.rgb.data() + picture.offset(from, y);
            const std::uint8_t* above = rgba.data() + picture.offset(from, y) / 3 * 4;
            for (int x = from; x < to; ++x, below += 3, above += 4) {
                const unsigned rest = 255U - above[3];
                if (rest == 255U) continue;
                for (std::size_t k = 0; k < 3; ++k) {
                    const unsigned sum = above[k] + (below[k] * rest + 127U) / 255U;
                    below[k] = static_cast<std::uint8_t>(std::min(255U, sum));
                }
            }
        }
    }
}

Overlay::Overlay(std::shared_ptr<GlDevice> device) : impl_(std::make_unique<Impl>(std::move(device))) {}
Overlay::~Overlay() = default;

void Overlay::draw(const HudDrawList& list, Image8& picture) {
    if (list.empty()) return;
    CATHLAB_CHECK(list.atlas != nullptr, "a draw list needs its atlas");
    CATHLAB_CHECK(std::lround(list.width) == picture.width && std::lround(list.height) == picture.height,
                  "the HUD was laid out for another size");
    Impl& self = *impl_;
    self.device->make_current();
    const GlTable& gl = self.device->gl();
    if (!self.buffer || self.buffer->width() != picture.width || self.buffer->height() != picture.height) {
        self.buffer = std::make_unique<GlFramebuffer>(self.device, picture.width, picture.height,
                                                      std::vector<GLenum>{GL_RGBA8}, false);
    }
    self.buffer->bind();
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    self.program.use();
    self.use_atlas(list.atlas);
    gl.Uniform1i(self.program.uniform("u_atlas"), 0);
    gl.Uniform2f(self.program.uniform("u_size"), list.width, list.height);

    self.vertices.clear();
    for (const DrawVertex& v : list.vertices) {
        self.vertices.insert(self.vertices.end(), {v.x, v.y, v.u, v.v});
        for (unsigned shift = 0; shift < 32; shift += 8) {
            self.vertices.push_back(static_cast<float>((v.rgba >> shift) & 0xFFU) / 255.0F);
        }
    }
    self.mesh.set_vertices(self.vertices);
    self.mesh.set_indices(list.indices);
    gl.Enable(GL_SCISSOR_TEST);
    for (const DrawCommand& command : list.commands) {
        const auto x = static_cast<GLint>(std::max(0.0F, command.x0));
        const auto y = static_cast<GLint>(std::max(0.0F, command.y0));
        const auto w = static_cast<GLsizei>(command.x1) - x;
        const auto h = static_cast<GLsizei>(command.y1) - y;
        if (w <= 0 || h <= 0) continue;
        gl.Scissor(x, y, w, h);
        self.mesh.draw(command.first_index, command.index_count);
    }
    gl.Disable(GL_SCISSOR_TEST);

    const int columns = (picture.width + tile_px - 1) / tile_px, rows = (picture.height + tile_px - 1) / tile_px;
    self.find_painted(list, columns, rows);
    self.read_painted(columns, rows);
    self.device->check("overlay");
    self.paint(columns, picture);
}

}  // namespace cathlab
