#include "render/inner_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

constexpr double near_mm = 0.15, far_mm = 400.0;  // the lens, and where no light comes back
constexpr double clearance_mm = 0.6;  // of the camera from the wall: the near plane's corners lie 0.26 mm away
constexpr std::size_t tube_sides = 14;
constexpr std::size_t floats_per_vertex = 13;

Vec3 wall_color(double force, double limit) {
    const Vec3 tissue(0.60, 0.125, 0.085), yellow(0.95, 0.72, 0.10), alarm(0.80, 0.62, 1.0);
    const double t = std::clamp(force / std::max(1e-9, limit), 0.0, 1.0);
    return t < 0.5 ? Vec3(tissue + 2 * t * (yellow - tissue)) : Vec3(yellow + (2 * t - 1) * (alarm - yellow));
}

// The shader's square root of the linear shade -> the display's gamma of 2.2.
std::array<std::uint8_t, 256> display_of_root() {
    std::array<std::uint8_t, 256> out{};
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::pow(static_cast<double>(i) / 255.0, 2.0 / 2.2)));
    return out;
}

struct Batch {
    std::vector<float> vertices;
    std::vector<GLuint> indices;

    GLuint add(const Vec3& position, const Vec3& normal, const Vec3& color, double gloss, const Vec3& grain) {
        const auto id = static_cast<GLuint>(vertices.size() / floats_per_vertex);
        const auto put = [&](const Vec3& v) {
            for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(v[k]));
        };
        put(position);
        put(normal);
        put(color);
        vertices.push_back(static_cast<float>(gloss));
        put(grain);
        return id;
    }
};

void add_device(const FrameDevice& device, const Pose& camera, Batch& out) {
    const std::size_t n = device.radius_mm.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a = camera.to_local(device.points[i]);
        const Vec3 b = camera.to_local(device.points[i + 1]);
        const double r = device.radius_mm[i];
        if (std::max(a.z(), b.z()) < near_mm || std::min(a.norm(), b.norm()) > 150) continue;
        const Vec3 axis = b - a;
        if (!(axis.norm() > 1e-6)) continue;
        // A camera inside a piece (on the wire that it rides on) looks past it.
        const double along = std::clamp(-a.dot(axis) / axis.squaredNorm(), 0.0, 1.0);
        if ((a + along * axis).norm() < r + near_mm) continue;
        const Vec3 u = axis.unitOrthogonal();
        const Vec3 v = axis.normalized().cross(u);
        std::array<GLuint, 2 * tube_sides> ring{};
        for (std::size_t s = 0; s < tube_sides; ++s) {
            const double angle = 2 * units::pi * static_cast<double>(s) / static_cast<double>(tube_sides);
            const Vec3 out_normal = std::cos(angle) * u + std::sin(angle) * v;
            ring[2 * s] = out.add(a + r * out_normal, out_normal, device.color, 0.9, Vec3::Zero());
            ring[2 * s + 1] = out.add(b + r * out_normal, out_normal, device.color, 0.9, Vec3::Zero());
        }
        for (std::size_t s = 0; s < tube_sides; ++s) {
            const std::size_t t = (s + 1) % tube_sides;
            out.indices.insert(out.indices.end(), {ring[2 * s], ring[2 * t], ring[2 * s + 1], ring[2 * s + 1],
                                                   ring[2 * t], ring[2 * t + 1]});
        }
        if (i == 0 || i + 1 == n) {  // close the free end
            const Vec3& end = i == 0 ? a : b;
            const Vec3 normal = (i == 0 ? Vec3(-axis) : axis).normalized();
            const GLuint middle = out.add(end + 0.5 * r * normal, normal, device.color, 0.9, Vec3::Zero());
            const std::size_t side = i == 0 ? 0 : 1;
            for (std::size_t s = 0; s < tube_sides; ++s) {
                out.indices.insert(out.indices.end(),
                                   {middle, ring[2 * s + side], ring[2 * ((s + 1) % tube_sides) + side]});
            }
        }
    }
}

// A camera on a tip that is pressed into the wall would stand in the wall or cut it with its near plane: it stays a
// little inside.  The nearest vertex's tangent plane stands for the wall.
Vec3 clear_of_wall(Vec3 camera, const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals) {
    for (int pass = 0; pass < 3 && !vertices.empty(); ++pass) {
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double d = (vertices[i] - camera).squaredNorm();
            if (d < least) {
                least = d;
                nearest = i;
            }
        }
        const double clear = (vertices[nearest] - camera).dot(normals[nearest]);  // normals point outward
        if (clear >= clearance_mm) break;
        camera -= (clearance_mm - clear) * normals[nearest];
    }
    return camera;
}

// Whether a triangle lies wholly on the outer side of one of the picture's four edges.
bool outside(const Vec3& p, const Vec3& q, const Vec3& r, double slope_x, double slope_y) {
    const double px = slope_x * p.z(), qx = slope_x * q.z(), rx = slope_x * r.z();
    const double py = slope_y * p.z(), qy = slope_y * q.z(), ry = slope_y * r.z();
    return (p.x() > px && q.x() > qx && r.x() > rx) || (-p.x() > px && -q.x() > qx && -r.x() > rx) ||
           (p.y() > py && q.y() > qy && r.y() > ry) || (-p.y() > py && -q.y() > qy && -r.y() > ry);
}

}  // namespace

struct InnerView::Impl {
    explicit Impl(GlDevicePtr d)
        : device(std::move(d)),
          program(device, shaders::tissue_vert, shaders::tissue_frag),
          mesh(device, {3, 3, 4, 3}) {}
    GlDevicePtr device;
    GlProgram program;
    GlMesh mesh;
    std::unique_ptr<GlFramebuffer> buffer;
    std::vector<std::uint8_t> rgba;
    std::array<std::uint8_t, 256> display = display_of_root();
    std::vector<Vec3> rest;  // where each vertex was first seen: the grain moves with the tissue
    std::uint64_t rest_revision = 0;
    Batch batch;
    std::vector<std::pair<float, GLuint>> near_first;  // (a measure of distance, triangle)

    void fill(const FrameDescription& frame, double aspect);
};

void InnerView::Impl::fill(const FrameDescription& frame, double aspect) {
    const FrameLumen& lumen = frame.lumen;
    const std::size_t n = lumen.vertices.size();
    if (rest.size() != n || rest_revision != lumen.topology_revision) {
        rest = lumen.vertices;
        rest_revision = lumen.topology_revision;
    }
    batch.vertices.clear();
    batch.indices.clear();
    std::vector<Vec3> computed;
    if (lumen.normals.size() != n) computed = vertex_normals({lumen.vertices, lumen.triangles});
    const std::vector<Vec3>& normals = computed.empty() ? lumen.normals : computed;

    Pose camera = frame.inner_camera->pose;
    camera.position = clear_of_wall(camera.position, lumen.vertices, normals);
    const double slope_y = std::tan(0.5 * frame.inner_camera->field_of_view_deg * units::deg);
    const double slope_x = slope_y * aspect;

    // Only what the light reaches and what stands before the camera is sent to GL.
    const double reach = std::min(far_mm, 4.5 * frame.inner_camera->light_range_mm);
    std::vector<Vec3> local(n);
    for (std::size_t i = 0; i < n; ++i) local[i] = camera.to_local(lumen.vertices[i]);
    const auto reached = [&](const Vec3& p) { return p.z() > -5.0 && p.squaredNorm() < reach * reach; };
    near_first.clear();
    for (std::size_t t = 0; t < lumen.triangles.size(); ++t) {
        const Triangle& corners = lumen.triangles[t];
        const Vec3& p = local[static_cast<std::size_t>(corners[0])];
        const Vec3& q = local[static_cast<std::size_t>(corners[1])];
        const Vec3& r = local[static_cast<std::size_t>(corners[2])];
        if (!reached(p) && !reached(q) && !reached(r)) continue;
        if (outside(p, q, r, slope_x, slope_y)) continue;
        if ((q - p).cross(r - p).dot(p) <= 0.0) continue;  // its outer side: never seen from inside
        near_first.emplace_back(static_cast<float>((p + q + r).squaredNorm()), static_cast<GLuint>(t));
    }
    // What is hidden is then found out before it is lit.
    std::sort(near_first.begin(), near_first.end());
    std::vector<std::int64_t> id(n, -1);
    const Quat to_camera = camera.orientation.conjugate();
    for (const auto& [distance, t] : near_first) {
        for (const Index corner : lumen.triangles[t]) {
            const auto i = static_cast<std::size_t>(corner);
            if (id[i] < 0) {
                const double force = lumen.wall_force_n.size() == n ? lumen.wall_force_n[i] : 0.0;
                id[i] = batch.add(local[i], to_camera * normals[i], wall_color(force, frame.wall_force_limit_n), 0.55,
                                  rest[i]);
            }
            batch.indices.push_back(static_cast<GLuint>(id[i]));
        }
    }
    for (const FrameDevice& d : frame.devices) add_device(d, camera, batch);
}

InnerView::InnerView(std::shared_ptr<GlDevice> device) : impl_(std::make_unique<Impl>(std::move(device))) {}
InnerView::~InnerView() = default;

void InnerView::draw(const FrameDescription& frame, int width, int height, Image8& out) {
    out = Image8(width, height);
    if (!frame.inner_camera) return;
    const FrameCamera& camera = *frame.inner_camera;
    CATHLAB_CHECK(camera.field_of_view_deg > 10 && camera.field_of_view_deg < 150, "field of view of the inner camera");
    Impl& self = *impl_;
    self.device->make_current();
    const double aspect = static_cast<double>(width) / height;
    self.fill(frame, aspect);

    const GlTable& gl = self.device->gl();
    if (!self.buffer || self.buffer->width() != width || self.buffer->height() != height) {
        self.buffer = std::make_unique<GlFramebuffer>(self.device, width, height, std::vector<GLenum>{GL_RGBA8}, true);
    }
    self.buffer->bind();
    gl.Disable(GL_BLEND);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_TRUE);
    gl.ClearColor(0, 0, 0, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    self.program.use();
    const auto matrix = perspective_matrix(camera.field_of_view_deg, aspect, near_mm, far_mm);
    gl.UniformMatrix4fv(self.program.uniform("u_clip"), 1, GL_FALSE, matrix.data());
    gl.Uniform1f(self.program.uniform("u_light_falloff"),
                 static_cast<float>(3.0 / (camera.light_range_mm * camera.light_range_mm)));
    self.mesh.set_vertices(self.batch.vertices);
    self.mesh.set_indices(self.batch.indices);
    self.mesh.draw();

    self.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    self.buffer->read(0, GL_RGBA, GL_UNSIGNED_BYTE, self.rgba.data());
    self.device->check("inner view");
    for (std::size_t i = 0; i < self.rgba.size() / 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) out.rgb[3 * i + k] = self.display[self.rgba[4 * i + k]];
    }
}

}  // namespace cathlab
