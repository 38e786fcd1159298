#include "render/path_lengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "render/path_surface.h"
#include "shader_sources.h"

namespace cathlab {

struct PathLengthBuffer::Impl {
    explicit Impl(GlDevicePtr d)
        : device(std::move(d)), program(device, shaders::path_length_vert, shaders::path_length_frag) {}

    GlDevicePtr device;
    GlProgram program;
    std::unique_ptr<GlFramebuffer> buffer;
    std::vector<float> sums;

    GlFramebuffer& buffer_of(const Projection& projection) {
        if (!buffer || buffer->width() != projection.width() || buffer->height() != projection.height())
            buffer = std::make_unique<GlFramebuffer>(device, projection.width(), projection.height(),
                                                     std::vector<GLenum>{GL_RG32F}, false);
        return *buffer;
    }
};

PathLengthBuffer::PathLengthBuffer(std::shared_ptr<GlDevice> device)
    : impl_(std::make_unique<Impl>(std::move(device))) {}
PathLengthBuffer::~PathLengthBuffer() = default;

std::unique_ptr<PathSurface> PathLengthBuffer::make_surface() const {
    impl_->device->make_current();
    return std::make_unique<PathSurface>(impl_->device);
}

void PathLengthBuffer::set_triangles(PathSurface& surface, const std::vector<Triangle>& triangles) const {
    impl_->device->make_current();
    std::vector<GLuint> indices;
    indices.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) indices.push_back(static_cast<GLuint>(t[k]));
    }
    surface.mesh.set_indices(indices);
}

void PathLengthBuffer::set_vertices(PathSurface& surface, const std::vector<Vec3>& vertices) const {
    impl_->device->make_current();
    std::vector<float> data;
    data.reserve(3 * vertices.size());
    for (const Vec3& v : vertices) {
        for (int k = 0; k < 3; ++k) data.push_back(static_cast<float>(v[k]));
    }
    surface.mesh.set_vertices(data);
}

void PathLengthBuffer::draw(const Projection& projection, const std::vector<const PathSurface*>& surfaces,
                            PathLengths& out) {
    impl_->device->make_current();
    const GlTable& gl = impl_->device->gl();
    GlFramebuffer& buffer = impl_->buffer_of(projection);
    buffer.bind();
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.ClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT);

    const GlProgram& program = impl_->program;
    program.use();
    const Vec3& s = projection.source();
    gl.Uniform3f(program.uniform("u_source"), static_cast<float>(s.x()), static_cast<float>(s.y()),
                 static_cast<float>(s.z()));
    gl.UniformMatrix4fv(program.uniform("u_detector"), 1, GL_FALSE, projection.clip_matrix().data());
    // Image rows run downward while GL's run upward: seen with down as GL's up, a view that is not mirrored to us is to
    // GL.
    gl.Uniform1f(program.uniform("u_leaves_where_front"), projection.mirrored() ? -1.0F : 1.0F);
    const auto reference = static_cast<float>(0.65 * projection.source_detector_mm());
    gl.Uniform1f(program.uniform("u_reference"), reference);
    for (const PathSurface* surface : surfaces) surface->mesh.draw();

    const std::size_t count =
        static_cast<std::size_t>(projection.width()) * static_cast<std::size_t>(projection.height());
    impl_->sums.resize(2 * count);
    buffer.read(0, GL_RG, GL_FLOAT, impl_->sums.data());
    impl_->device->check("path lengths");

    out.bad_pixels = 0;
    out.length_mm.width = out.contrast_mm_mg_ml.width = projection.width();
    out.length_mm.height = out.contrast_mm_mg_ml.height = projection.height();
    out.length_mm.values.resize(count);
    out.contrast_mm_mg_ml.values.clear();
    for (std::size_t i = 0; i < count; ++i) {
        const float* sum = impl_->sums.data() + 2 * i;
        const bool bad = std::fabs(sum[1]) > 0.5F;
        out.bad_pixels += bad ? 1 : 0;
        out.length_mm.values[i] = bad ? 0.0F : sum[0];
    }
}

}  // namespace cathlab
