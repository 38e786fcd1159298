#include "render/path_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace cathlab {

namespace {

constexpr std::int64_t steps = 256;   // a pixel's
constexpr double farthest = 1 << 22;  // of a corner from the picture, in steps
constexpr double nearest_mm = 1e-3;   // of a corner to the source

// On which side of the edge from a to b a point lies: positive inside, and zero only for the one of the two triangles
// of an edge to which its pixels belong.
struct Edge {
    std::int64_t value, right, down;  // at the box's first pixel; per pixel

    template <class Corner>
    Edge(const Corner& a, const Corner& b, std::int64_t i, std::int64_t j) {
        const std::int64_t di = b.i - a.i, dj = b.j - a.j;
        const bool owns = dj > 0 || (dj == 0 && di > 0);
        value = di * (j - a.j) - dj * (i - a.i) - (owns ? 0 : 1);
        right = -dj * steps;
        down = di * steps;
    }
};

int first_pixel(std::int64_t step) {
    return static_cast<int>((step + steps - 1) >> 8);
}
int last_pixel(std::int64_t step) {
    return static_cast<int>(step >> 8);
}

}  // namespace

void PathRaster::project(const Projection& projection, std::span<const Vec3> vertices) {
    const double sid = projection.source_detector_mm();
    const Vec3 first = projection.to_detector(0.5, 0.5);
    const Vec3 across = projection.to_detector(1.5, 0.5) - first, along = projection.to_detector(0.5, 1.5) - first;
    const double pixel_x = across.norm(), pixel_y = along.norm();
    const Vec3 right = across / pixel_x, down = along / pixel_y;
    const double x0 = first.dot(right), y0 = first.dot(down);
    slope_x_.resize(static_cast<std::size_t>(width_));
    slope_y_.resize(static_cast<std::size_t>(height_));
    for (std::size_t i = 0; i < slope_x_.size(); ++i) slope_x_[i] = (x0 + pixel_x * static_cast<double>(i)) / sid;
    for (std::size_t j = 0; j < slope_y_.size(); ++j) slope_y_[j] = (y0 + pixel_y * static_cast<double>(j)) / sid;

    const double scale_x = static_cast<double>(steps) / pixel_x, scale_y = static_cast<double>(steps) / pixel_y;
    const auto snapped = [](double v) {
        return static_cast<std::int64_t>(std::floor(std::clamp(v, -farthest, farthest) + 0.5));
    };
    corners_.resize(vertices.size());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Vec3 p = vertices[k] - projection.source();
        Corner& c = corners_[k];
        c.x = p.dot(right);
        c.y = p.dot(down);
        c.z = p.dot(projection.normal());
        CATHLAB_CHECK(c.z > nearest_mm, "a surface reaches behind the X-ray source");
        c.inverse = 1.0 / c.z;
        c.i = snapped((sid * c.x * c.inverse - x0) * scale_x);
        c.j = snapped((sid * c.y * c.inverse - y0) * scale_y);
    }
}

template <bool with_values>
void PathRaster::add(const Triangle& t, std::span<const double> values) {
    const Corner& a = corners_[static_cast<std::size_t>(t[0])];
    const Corner* b = &corners_[static_cast<std::size_t>(t[1])];
    const Corner* c = &corners_[static_cast<std::size_t>(t[2])];
    const auto [low_i, high_i] = std::minmax({a.i, b->i, c->i});
    const auto [low_j, high_j] = std::minmax({a.j, b->j, c->j});
    const int left = std::max(0, first_pixel(low_i)), right = std::min(width_ - 1, last_pixel(high_i));
    const int top = std::max(0, first_pixel(low_j)), bottom = std::min(height_ - 1, last_pixel(high_j));
    if (left > right || top > bottom) return;  // between the pixels' centres, or outside
    const std::int64_t area = (b->i - a.i) * (c->j - a.j) - (b->j - a.j) * (c->i - a.i);
    if (area == 0) return;

    // The plane n . p = offset; on the ray p = depth * (slope_x, slope_y, 1).
    const double ux = b->x - a.x, uy = b->y - a.y, uz = b->z - a.z;
    const double vx = c->x - a.x, vy = c->y - a.y, vz = c->z - a.z;
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double offset = nx * a.x + ny * a.y + nz * a.z;
    // Seen edge-on, a plane is not met where its snapped triangle lies: never farther than the corners.
    const double least = std::min({a.inverse, b->inverse, c->inverse});
    const double most = std::max({a.inverse, b->inverse, c->inverse});
    const double per_offset = std::fabs(offset) > 1e-12 ? 1.0 / offset : 0.0;
    nx *= per_offset;
    ny *= per_offset;
    nz *= per_offset;

    double value_0 = 0.0, gx = 0.0, gy = 0.0, gz = 0.0;  // value = value_0 + depth * (g . ray)
    if constexpr (with_values) {
        const double va = values[static_cast<std::size_t>(t[0])];
        const double du = values[static_cast<std::size_t>(t[1])] - va, dv = values[static_cast<std::size_t>(t[2])] - va;
        // The gradient within the plane, from its two edges u and v.
        const double uu = ux * ux + uy * uy + uz * uz, uv = ux * vx + uy * vy + uz * vz,
                     vv = vx * vx + vy * vy + vz * vz;
        const double det = uu * vv - uv * uv;
        const double per_det = det > 1e-18 ? 1.0 / det : 0.0;
        const double along_u = (vv * du - uv * dv) * per_det, along_v = (uu * dv - uv * du) * per_det;
        gx = along_u * ux + along_v * vx;
        gy = along_u * uy + along_v * vy;
        gz = along_u * uz + along_v * vz;
        value_0 = va - (gx * a.x + gy * a.y + gz * a.z);
    }

    const bool leaves = (area > 0) != mirrored_;
    const float sign = leaves ? 1.0F : -1.0F;
    if (area < 0) std::swap(b, c);
    const std::int64_t i = left * steps, j = top * steps;
    Edge ab(a, *b, i, j), bc(*b, *c, i, j), ca(*c, a, i, j);
    for (int y = top; y <= bottom; ++y) {
        const double row = ny * slope_y_[static_cast<std::size_t>(y)] + nz;
        const std::size_t start = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
        std::int64_t e0 = ab.value, e1 = bc.value, e2 = ca.value;
        bool inside = false;
        for (int x = left; x <= right; ++x, e0 += ab.right, e1 += bc.right, e2 += ca.right) {
            if ((e0 | e1 | e2) < 0) {
                if (inside) break;
                continue;
            }
            inside = true;
            const double slope_x = slope_x_[static_cast<std::size_t>(x)];
            const double inverse = std::min(most, std::max(least, nx * slope_x + row));
            const double depth = 1.0 / inverse;
            const auto d = static_cast<float>(depth - reference_);
            Sum& sum = sums_[start + static_cast<std::size_t>(x)];
            sum.depth += sign * d;
            sum.exits += sign;
            if constexpr (with_values) {
                const double value = value_0 + depth * (gx * slope_x + gy * slope_y_[static_cast<std::size_t>(y)] + gz);
                const auto v = static_cast<float>(value);
                Moments& moments = moments_[start + static_cast<std::size_t>(x)];
                moments.value_depth += sign * v * d;
                moments.value += sign * v;
                moments.depth_2 += sign * d * d;
            }
        }
        ab.value += ab.down;
        bc.value += bc.down;
        ca.value += ca.down;
    }
}

void PathRaster::draw(const Projection& projection, std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                      std::span<const double> values, PathLengths& out) {
    CATHLAB_CHECK(values.empty() || values.size() == vertices.size(), "one value a vertex");
    const bool with_values = std::any_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
    width_ = projection.width();
    height_ = projection.height();
    mirrored_ = projection.mirrored();
    reference_ = 0.65 * projection.source_detector_mm();
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    project(projection, vertices);
    sums_.assign(count, Sum{});
    if (with_values) {
        moments_.assign(count, Moments{});
        for (const Triangle& t : triangles) add<true>(t, values);
    } else {
        for (const Triangle& t : triangles) add<false>(t, values);
    }

    out.bad_pixels = 0;
    out.length_mm.width = out.contrast_mm_mg_ml.width = width_;
    out.length_mm.height = out.contrast_mm_mg_ml.height = height_;
    out.length_mm.values.resize(count);
    out.contrast_mm_mg_ml.values.assign(with_values ? count : 0, 0.0F);
    for (std::size_t y = 0, n = 0; y < slope_y_.size(); ++y) {
        for (std::size_t x = 0; x < slope_x_.size(); ++x, ++n) {
            const Sum& sum = sums_[n];
            const bool bad = sum.exits != 0.0F;
            out.bad_pixels += bad ? 1 : 0;
            float length = 0.0F;
            if (sum.depth != 0.0F && !bad) {
                // From depth along the normal to distance along the ray.
                const double slant = std::sqrt(1.0 + slope_x_[x] * slope_x_[x] + slope_y_[y] * slope_y_[y]);
                length = static_cast<float>(sum.depth * slant);
                if (with_values && length > 1e-3F) {
                    // For one entry (d0, c0) and one exit (d1, c1): sum c d = c1 d1 - c0 d0, sum c = c1 - c0, and the
                    // mean depth is (d1^2 - d0^2) / 2 (d1 - d0), which together give the trapezoid
                    // (c0 + c1) / 2 * (d1 - d0) exactly.
                    const Moments& m = moments_[n];
                    const float middle = 0.5F * m.depth_2 / sum.depth;
                    out.contrast_mm_mg_ml.values[n] =
                        static_cast<float>(slant) * std::max(0.0F, m.value_depth - m.value * middle);
                }
            }
            out.length_mm.values[n] = length;
        }
    }
}

}  // namespace cathlab
