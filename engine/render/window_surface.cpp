#include "render/window_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/check.h"
#include "render/gl_device.h"
#include "shader_sources.h"

namespace cathlab {
namespace {

struct Texture {
    GLuint id = 0;
    int width = 0, height = 0;
    std::uint64_t revision = 0;
    const void* content = nullptr;  // the picture, or null
    std::shared_ptr<const DrawAtlas> atlas;
};

}  // namespace

struct WindowSurface::Impl {
    Impl(std::unique_ptr<GlTarget> target, bool own)
        : device(std::make_shared<GlDevice>(std::move(target))),
          program(device, shaders::window_vert, shaders::window_frag),
          mesh(device, {2, 2, 4}),
          own_framebuffer(own) {}
    ~Impl() {
        device->make_current();
        for (const auto* kind : {&pictures, &atlases})
            for (const Texture& t : *kind) device->gl().DeleteTextures(1, &t.id);
    }

    GlDevicePtr device;
    GlProgram program;
    GlMesh mesh;
    bool own_framebuffer;
    std::unique_ptr<GlFramebuffer> buffer;
    int width = 0, height = 0;
    std::vector<Texture> pictures, atlases;
    std::vector<float> vertices;
    std::vector<std::uint8_t> rgba;

    void begin(int w, int h);
    void make(Texture& texture) const;
    void bind_picture(std::size_t slot, const WindowPicture& picture);
    void bind_atlas(const std::shared_ptr<const DrawAtlas>& atlas);
    void draw_picture(const WindowPicture& picture);
    void draw_list(const HudDrawList& list);
};

void WindowSurface::Impl::begin(int w, int h) {
    width = w;
    height = h;
    device->make_current();
    const GlTable& gl = device->gl();
    if (own_framebuffer) {
        if (!buffer || buffer->width() != w || buffer->height() != h)
            buffer = std::make_unique<GlFramebuffer>(device, w, h, std::vector<GLenum>{GL_RGBA8}, false);
        buffer->bind();
    } else {
        gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
        gl.Viewport(0, 0, w, h);
    }
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_BLEND);
    gl.ClearColor(0, 0, 0, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    program.use();
    gl.Uniform1i(program.uniform("u_texture"), 0);
    gl.Uniform2f(program.uniform("u_size"), static_cast<float>(w), static_cast<float>(h));
    gl.Uniform1f(program.uniform("u_up"), own_framebuffer ? 1.0F : -1.0F);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

void WindowSurface::Impl::make(Texture& texture) const {
    const GlTable& gl = device->gl();
    gl.GenTextures(1, &texture.id);
    gl.BindTexture(GL_TEXTURE_2D, texture.id);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void WindowSurface::Impl::bind_picture(std::size_t slot, const WindowPicture& picture) {
    const GlTable& gl = device->gl();
    if (slot >= pictures.size()) make(pictures.emplace_back());
    Texture& texture = pictures[slot];
    gl.BindTexture(GL_TEXTURE_2D, texture.id);
    const Image8& image = *picture.picture;
    if (texture.content == &image && texture.revision == picture.revision && texture.width == image.width &&
        texture.height == image.height)
        return;
    texture.content = &image;
    texture.revision = picture.revision;
    texture.width = image.width;
    texture.height = image.height;
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
}

void WindowSurface::Impl::bind_atlas(const std::shared_ptr<const DrawAtlas>& atlas) {
    const GlTable& gl = device->gl();
    for (const Texture& known : atlases) {
        if (known.atlas != atlas) continue;
        gl.BindTexture(GL_TEXTURE_2D, known.id);
        return;
    }
    // Fonts of an earlier size are not used any more.
    std::erase_if(atlases, [&](const Texture& t) {
        if (t.atlas.use_count() > 1) return false;
        gl.DeleteTextures(1, &t.id);
        return true;
    });
    make(atlases.emplace_back());
    atlases.back().atlas = atlas;
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, atlas->width, atlas->height, 0, GL_RED, GL_UNSIGNED_BYTE,
                  atlas->alpha.data());
}

void WindowSurface::Impl::draw_picture(const WindowPicture& picture) {
    const FrameRect& r = picture.place;
    const auto x0 = static_cast<float>(r.x), y0 = static_cast<float>(r.y);
    const float x1 = x0 + static_cast<float>(r.width), y1 = y0 + static_cast<float>(r.height);
    vertices = {x0, y0, 0, 0, 1, 1, 1, 1, x1, y0, 1, 0, 1, 1, 1, 1, x1, y1, 1, 1, 1, 1, 1, 1, x0, y1, 0, 1, 1, 1, 1, 1};
    mesh.set_vertices(vertices);
    mesh.set_indices({0, 1, 2, 0, 2, 3});
    mesh.draw();
}

void WindowSurface::Impl::draw_list(const HudDrawList& list) {
    CATHLAB_CHECK(list.atlas != nullptr, "a draw list needs its atlas");
    const GlTable& gl = device->gl();
    bind_atlas(list.atlas);
    vertices.clear();
    vertices.reserve(8 * list.vertices.size());
    for (const DrawVertex& v : list.vertices) {
        vertices.insert(vertices.end(), {v.x, v.y, v.u, v.v});
        for (unsigned shift = 0; shift < 32; shift += 8)
            vertices.push_back(static_cast<float>((v.rgba >> shift) & 0xFFU) / 255.0F);
    }
    mesh.set_vertices(vertices);
    mesh.set_indices(list.indices);
    for (const DrawCommand& command : list.commands) {
        const int x = std::max(0, static_cast<int>(command.x0)), y = std::max(0, static_cast<int>(command.y0));
        const int x1 = std::min(width, static_cast<int>(command.x1));
        const int y1 = std::min(height, static_cast<int>(command.y1));
        if (x1 <= x || y1 <= y) continue;
        gl.Scissor(x, own_framebuffer ? y : height - y1, x1 - x, y1 - y);
        mesh.draw(command.first_index, command.index_count);
    }
}

WindowSurface::WindowSurface(std::unique_ptr<GlTarget> target, bool own_framebuffer)
    : impl_(std::make_unique<Impl>(std::move(target), own_framebuffer)) {}
WindowSurface::~WindowSurface() = default;

void WindowSurface::draw(int width, int height, std::span<const WindowPicture> pictures,
                         std::span<const HudDrawList* const> lists) {
    CATHLAB_CHECK(width > 0 && height > 0, "a window has a size");
    Impl& self = *impl_;
    self.begin(width, height);
    const GlTable& gl = self.device->gl();
    const GLint coverage = self.program.uniform("u_coverage");
    gl.Uniform1i(coverage, 0);
    std::size_t slot = 0;
    for (const WindowPicture& picture : pictures) {
        if (picture.picture == nullptr || picture.picture->rgb.empty() || picture.place.width <= 0) continue;
        self.bind_picture(slot++, picture);
        self.draw_picture(picture);
    }
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Uniform1i(coverage, 1);
    for (const HudDrawList* list : lists)
        if (list != nullptr && !list->empty()) self.draw_list(*list);
    gl.Disable(GL_SCISSOR_TEST);
    self.device->check("window");
}

void WindowSurface::read(Image8& out) {
    Impl& self = *impl_;
    if (self.width == 0) return;
    self.device->make_current();
    const GlTable& gl = self.device->gl();
    const auto w = static_cast<std::size_t>(self.width), h = static_cast<std::size_t>(self.height);
    if (out.width != self.width || out.height != self.height) out = Image8(self.width, self.height);
    self.rgba.resize(4 * w * h);
    if (self.own_framebuffer) {
        self.buffer->read(0, GL_RGBA, GL_UNSIGNED_BYTE, self.rgba.data());
    } else {
        gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
        gl.ReadBuffer(GL_BACK);
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.ReadPixels(0, 0, self.width, self.height, GL_RGBA, GL_UNSIGNED_BYTE, self.rgba.data());
    }
    for (std::size_t y = 0; y < h; ++y) {
        const std::uint8_t* from = self.rgba.data() + 4 * w * (self.own_framebuffer ? y : h - 1 - y);
        std::uint8_t* to = out.rgb.data() + 3 * w * y;
        for (std::size_t x = 0; x < w; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
    }
    self.device->check("reading the window");
}

std::string WindowSurface::description() const {
    return impl_->device->description();
}

}  // namespace cathlab
