#include "render/outer_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/mesh.h"
#include "core/units.h"
#include "render/gl_device.h"
#include "render/perspective.h"
#include "shader_sources.h"

namespace cathlab {
namespace {

constexpr double near_mm = 5.0, far_mm = 3000.0;
constexpr double full_displacement_mm = 10.0;  // of the wall: the end of the colours
constexpr float glass = 0.16F;
constexpr std::size_t tube_sides = 10;
// A wire of its true width would be half a pixel: it is drawn at least so thick, as a share of its distance.
constexpr double least_radius_share = 0.0032;
constexpr Vec3::Scalar background = 0.004;

std::array<std::uint8_t, 256> display_of_root() {
    std::array<std::uint8_t, 256> out{};
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::pow(static_cast<double>(i) / 255.0, 2.0 / 2.2)));
    return out;
}

struct Batch {
    std::vector<float> vertices;
    std::vector<GLuint> indices;
    GLuint count = 0;

    GLuint add(const Vec3& position, const Vec3& normal, const Vec3& color) {
        for (const Vec3* v : {&position, &normal, &color})
            for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>((*v)[k]));
        return count++;
    }
    void clear() {
        vertices.clear();
        indices.clear();
        count = 0;
    }
};

void add_device(const FrameDevice& device, const Pose& camera, Batch& out) {
    const std::size_t n = device.radius_mm.size();
    std::vector<Vec3> points;
    for (const Vec3& p : device.points) points.push_back(camera.to_local(p));
    std::vector<GLuint> before, ring(tube_sides);
    for (std::size_t i = 0; i <= n && n > 0; ++i) {
        const Vec3 along = points[std::min(i + 1, n)] - points[i == 0 ? 0 : i - 1];
        if (!(along.norm() > 1e-9)) continue;
        const Vec3 axis = along.normalized();
        const Vec3 u = axis.cross(std::fabs(axis.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
        const Vec3 v = axis.cross(u);
        const double r = std::max(device.radius_mm[std::min(i, n - 1)], least_radius_share * points[i].norm());
        for (std::size_t s = 0; s < tube_sides; ++s) {
            const double angle = 2 * units::pi * static_cast<double>(s) / static_cast<double>(tube_sides);
            const Vec3 normal = std::cos(angle) * u + std::sin(angle) * v;
            ring[s] = out.add(points[i] + r * normal, normal, device.color);
        }
        for (std::size_t s = 0; s < tube_sides && !before.empty(); ++s) {
            const std::size_t t = (s + 1) % tube_sides;
            out.indices.insert(out.indices.end(), {before[s], before[t], ring[s], ring[s], before[t], ring[t]});
        }
        before = ring;
    }
}

}  // namespace

Vec3 map_color(double share) {
    const Vec3 wall(0.50, 0.16, 0.13), yellow(0.95, 0.72, 0.10), pale(0.80, 0.62, 1.0);
    const double t = std::clamp(share, 0.0, 1.0);
    return t < 0.5 ? Vec3(wall + 2 * t * (yellow - wall)) : Vec3(yellow + (2 * t - 1) * (pale - yellow));
}

struct OuterView::Impl {
    explicit Impl(GlDevicePtr d)
        : device(std::move(d)),
          program(device, shaders::outer_vert, shaders::outer_frag),
          wall(device, {3, 3, 3}),
          devices(device, {3, 3, 3}) {}
    GlDevicePtr device;
    GlProgram program;
    GlMesh wall, devices;
    std::unique_ptr<GlFramebuffer> buffer;
    std::vector<std::uint8_t> rgba;
    std::array<std::uint8_t, 256> display = display_of_root();
    Batch batch;
    std::uint64_t wall_revision = 0;
    std::size_t wall_triangles = 0;

    void fill_wall(const FrameDescription& frame);
    void fill_devices(const FrameDescription& frame);
};

void OuterView::Impl::fill_wall(const FrameDescription& frame) {
    const FrameLumen& lumen = frame.lumen;
    const std::size_t n = lumen.vertices.size();
    std::vector<Vec3> computed;
    if (lumen.normals.size() != n) computed = vertex_normals({lumen.vertices, lumen.triangles});
    const std::vector<Vec3>& normals = computed.empty() ? lumen.normals : computed;
    const Pose& camera = frame.outer_camera->pose;
    const Mat3 turn = camera.orientation.conjugate().toRotationMatrix();
    const bool force = frame.outer_map == OuterMap::force;
    const std::vector<double>& values = force ? lumen.wall_force_n : lumen.displacement_mm;
    const double full = force ? std::max(1e-9, frame.wall_force_limit_n) : full_displacement_mm;
    batch.clear();
    batch.vertices.reserve(9 * n);
    for (std::size_t i = 0; i < n; ++i)
        batch.add(turn * (lumen.vertices[i] - camera.position), turn * normals[i],
                  map_color(values.size() == n ? values[i] / full : 0.0));
    wall.set_vertices(batch.vertices);
    if (wall_revision == lumen.topology_revision && wall_triangles == lumen.triangles.size()) return;
    wall_revision = lumen.topology_revision;
    wall_triangles = lumen.triangles.size();
    for (const Triangle& t : lumen.triangles)
        for (const Index corner : t) batch.indices.push_back(static_cast<GLuint>(corner));
    wall.set_indices(batch.indices);
}

void OuterView::Impl::fill_devices(const FrameDescription& frame) {
    batch.clear();
    for (const FrameDevice& d : frame.devices) add_device(d, frame.outer_camera->pose, batch);
    devices.set_vertices(batch.vertices);
    devices.set_indices(batch.indices);
}

OuterView::OuterView(std::shared_ptr<GlDevice> device) : impl_(std::make_unique<Impl>(std::move(device))) {}
OuterView::~OuterView() = default;

void OuterView::draw(const FrameDescription& frame, int width, int height, Image8& out) {
    out = Image8(width, height);
    if (!frame.outer_camera) return;
    CATHLAB_CHECK(frame.outer_camera->field_of_view_deg > 10 && frame.outer_camera->field_of_view_deg < 150,
                  "field of view of the outer camera");
    Impl& self = *impl_;
    self.device->make_current();
    self.fill_wall(frame);
    self.fill_devices(frame);
    const GlTable& gl = self.device->gl();
    if (!self.buffer || self.buffer->width() != width || self.buffer->height() != height)
        self.buffer = std::make_unique<GlFramebuffer>(self.device, width, height, std::vector<GLenum>{GL_RGBA8}, true);
    self.buffer->bind();
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_BLEND);
    gl.Disable(GL_CULL_FACE);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_TRUE);
    const auto dark = static_cast<float>(std::sqrt(background));
    gl.ClearColor(dark, dark, dark, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    self.program.use();
    const auto matrix =
        perspective_matrix(frame.outer_camera->field_of_view_deg, static_cast<double>(width) / height, near_mm, far_mm);
    gl.UniformMatrix4fv(self.program.uniform("u_clip"), 1, GL_FALSE, matrix.data());
    const GLint alpha = self.program.uniform("u_alpha");
    gl.Uniform1f(alpha, 1.0F);
    self.devices.draw();
    // Glass: both sides of it over the devices, whatever the order; it hides none of them.
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl.DepthMask(GL_FALSE);
    gl.Uniform1f(alpha, glass);
    self.wall.draw();
    gl.DepthMask(GL_TRUE);
    gl.Disable(GL_BLEND);

    self.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    self.buffer->read(0, GL_RGBA, GL_UNSIGNED_BYTE, self.rgba.data());
    self.device->check("outer view");
    for (std::size_t i = 0; i < self.rgba.size() / 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) out.rgb[3 * i + k] = self.display[self.rgba[4 * i + k]];
}

}  // namespace cathlab
