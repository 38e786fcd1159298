#include "render/path_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace cathlab {

namespace {

constexpr double farthest_px = 1 << 20;  // of a corner from the picture
constexpr double nearest_mm = 1e-3;      // of a corner to the source
constexpr int band_rows = 16;            // drawn by one thread: its sums stay in the cache
constexpr std::size_t chunk = 2048;      // triangles that one thread sorts into bands
constexpr std::size_t long_row = 12;     // pixels from which the loop of many at a time is worth its call

// The least whole number that is not below v, at most `limit`, at least 0.
int ceiling(double v, int limit) {
    const double bounded = std::min(std::max(v, 0.0), static_cast<double>(limit));
    const auto whole = static_cast<int>(bounded);
    return whole + (bounded > whole ? 1 : 0);
}

// Where an edge lies in a row.  Made from its upper end to its lower by both of its triangles, hence the same in both.
struct EdgeLine {
    double column, row, slope;

    template <class Corner>
    EdgeLine(const Corner& upper, const Corner& lower)
        : column(upper.column), row(upper.row), slope((lower.column - upper.column) / (lower.row - upper.row)) {}
    int first_pixel(int y, int width) const { return ceiling(column + (y - row) * slope, width); }
};

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

    const double per_pixel_x = 1.0 / pixel_x, per_pixel_y = 1.0 / pixel_y;
    corners_.resize(vertices.size());
    workers_.for_ranges(vertices.size(), chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Vec3 p = vertices[k] - projection.source();
            Corner& c = corners_[k];
            c.x = p.dot(right);
            c.y = p.dot(down);
            c.z = p.dot(projection.normal());
            CATHLAB_CHECK(c.z > nearest_mm, "a surface reaches behind the X-ray source");
            c.inverse = 1.0 / c.z;
            c.column = std::clamp((sid * c.x * c.inverse - x0) * per_pixel_x, -farthest_px, farthest_px);
            c.row = std::clamp((sid * c.y * c.inverse - y0) * per_pixel_y, -farthest_px, farthest_px);
        }
    });
}

void PathRaster::sort_into_bands(std::span<const Triangle> triangles) {
    bands_.resize(static_cast<std::size_t>((height_ + band_rows - 1) / band_rows));
    for (std::size_t i = 0; i < bands_.size(); ++i) {
        bands_[i].begin = static_cast<int>(i) * band_rows;
        bands_[i].end = std::min(height_, bands_[i].begin + band_rows);
    }
    chunks_ = (triangles.size() + chunk - 1) / chunk;
    touching_.resize(std::max(touching_.size(), chunks_ * bands_.size()));
    workers_.for_ranges(chunks_, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            std::vector<std::uint32_t>* lists = touching_.data() + k * bands_.size();
            for (std::size_t i = 0; i < bands_.size(); ++i) lists[i].clear();
            for (std::size_t n = k * chunk; n < std::min(triangles.size(), (k + 1) * chunk); ++n) {
                const Triangle& t = triangles[n];
                const Corner& a = corners_[static_cast<std::size_t>(t[0])];
                const Corner& b = corners_[static_cast<std::size_t>(t[1])];
                const Corner& c = corners_[static_cast<std::size_t>(t[2])];
                const int top = ceiling(std::min({a.row, b.row, c.row}), height_);
                const int bottom = ceiling(std::max({a.row, b.row, c.row}), height_);
                if (top == bottom) continue;  // between two rows' centres, or outside
                if (std::max({a.column, b.column, c.column}) <= -1.0) continue;
                if (std::min({a.column, b.column, c.column}) >= width_) continue;
                for (int i = top / band_rows; i <= (bottom - 1) / band_rows; ++i)
                    lists[i].push_back(static_cast<std::uint32_t>(n));
            }
        }
    });
}

template <bool with_values>
void PathRaster::add(const Triangle& t, const Job& job, Band& band) const {
    const Corner& a = corners_[static_cast<std::size_t>(t[0])];
    const Corner& b = corners_[static_cast<std::size_t>(t[1])];
    const Corner& c = corners_[static_cast<std::size_t>(t[2])];
    // From top to bottom; each exchange turns the way round.
    const Corner *upper = &a, *middle = &b, *lower = &c;
    bool turned = mirrored_;
    const auto order = [&](const Corner*& first, const Corner*& second) {
        if (first->row <= second->row) return;
        std::swap(first, second);
        turned = !turned;
    };
    order(upper, middle);
    order(middle, lower);
    order(upper, middle);
    const int top = std::max(band.begin, ceiling(upper->row, height_)), waist = ceiling(middle->row, height_);
    const int bottom = std::min(band.end, ceiling(lower->row, height_));

    // The plane n . p = offset; on the ray p = depth * (slope_x, slope_y, 1).
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double offset = nx * a.x + ny * a.y + nz * a.z;
    // Seen edge-on, a plane is hardly met where its triangle lies: never farther than the corners.
    const double least = std::min({a.inverse, b.inverse, c.inverse});
    const double most = std::max({a.inverse, b.inverse, c.inverse});
    const double per_offset = std::fabs(offset) > 1e-12 ? 1.0 / offset : 0.0;
    nx *= per_offset;
    ny *= per_offset;
    nz *= per_offset;

    float width = 1.0F;
    double value_0 = 0.0, gx = 0.0, gy = 0.0, gz = 0.0;  // value = value_0 + depth * (g . ray)
    if constexpr (with_values) {
        if (!job.widths.empty()) {
            double sum = 0.0;
            for (int k = 0; k < 3; ++k) sum += job.widths[static_cast<std::size_t>(t[k])];
            width = static_cast<float>(sum / 3.0);
        }
        const std::span<const double> values = job.values;
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

    const EdgeLine whole(*upper, *lower), first(*upper, *middle), second(*middle, *lower);
    for (int y = top; y < bottom; ++y) {
        const double slope_y = slope_y_[static_cast<std::size_t>(y)];
        const double row = ny * slope_y + nz;
        int begin = (y < waist ? first : second).first_pixel(y, width_), end = whole.first_pixel(y, width_);
        // Corners that run clockwise on the picture (rows run downward) are an outer side seen from behind: an exit.
        float sign = turned ? -1.0F : 1.0F;
        if (begin < end) sign = -sign;
        if (begin > end) std::swap(begin, end);
        const std::size_t start = static_cast<std::size_t>(y - band.begin) * static_cast<std::size_t>(width_);
        const auto from = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end) - from;
        if (!with_values && count >= long_row) {
            loops_->add_depths(slope_x_.data() + from, count, {nx, row, least, most, reference_, sign},
                               band.depth.data() + start + from, band.exits.data() + start + from);
            continue;
        }
        for (std::size_t x = from; x < from + count; ++x) {
            const double slope_x = slope_x_[x];
            const double depth = 1.0 / std::min(most, std::max(least, nx * slope_x + row));
            const auto d = static_cast<float>(depth - reference_);
            band.depth[start + x] += sign * d;
            band.exits[start + x] += sign;
            if constexpr (with_values) {
                const auto v = static_cast<float>(value_0 + depth * (gx * slope_x + gy * slope_y + gz));
                band.met.emplace_back(static_cast<std::uint32_t>(start + x), Crossing{d, v, width, sign});
            }
        }
    }
}

// By pixel in two passes, as many crossings are met as the surface has layers; then by depth within each.
void PathRaster::Band::sort_crossings() {
    const std::size_t pixels = depth.size();
    first.assign(pixels + 1, 0);
    for (const auto& [pixel, crossing] : met) ++first[pixel + 1];
    for (std::size_t i = 0; i < pixels; ++i) first[i + 1] += first[i];
    crossings.resize(met.size());
    for (const auto& [pixel, crossing] : met) {  // first runs along to each pixel's end
        std::uint32_t& end = first[pixel];
        crossings[end++] = crossing;
    }
    // Each now says where the next pixel begins: back by one.
    for (std::size_t i = pixels; i > 0; --i) first[i] = first[i - 1];
    first[0] = 0;
    // A handful each: by insertion.
    const auto before = [](const Crossing& a, const Crossing& b) {
        return a.depth != b.depth ? a.depth < b.depth : a.exit < b.exit;
    };
    for (std::size_t i = 0; i < pixels; ++i) {
        for (std::uint32_t k = first[i] + 1; k < first[i + 1]; ++k) {
            const Crossing moved = crossings[k];
            std::uint32_t to = k;
            for (; to > first[i] && before(moved, crossings[to - 1]); --to) crossings[to] = crossings[to - 1];
            crossings[to] = moved;
        }
    }
}

// Along the depth; on a closed surface as many exits as entries.
float PathRaster::Band::integral(std::size_t pixel) const {
    float sum = 0.0F, layers = 0.0F;
    for (std::size_t k = first[pixel]; k + 1 < first[pixel + 1]; ++k) {
        const Crossing &here = crossings[k], &next = crossings[k + 1];
        layers -= here.exit;
        if (layers > 0.0F)
            sum += layers * (here.width * here.value + next.width * next.value) / (here.width + next.width) *
                   (next.depth - here.depth);
    }
    return std::max(0.0F, sum);
}

void PathRaster::draw_band(std::size_t index, const Job& job, PathLengths& out) {
    Band& band = bands_[index];
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t pixels = width * static_cast<std::size_t>(band.end - band.begin);
    const std::size_t offset = width * static_cast<std::size_t>(band.begin);
    band.bad = 0;
    bool touched = false;
    for (std::size_t k = 0; k < chunks_; ++k) {
        const std::vector<std::uint32_t>& touching = touching_[k * bands_.size() + index];
        if (touching.empty()) continue;
        if (!touched) {
            band.depth.assign(pixels, 0.0F);
            band.exits.assign(pixels, 0.0F);
            band.met.clear();
            touched = true;
        }
        if (job.with_values)
            for (const std::uint32_t n : touching) add<true>(job.triangles[n], job, band);
        else
            for (const std::uint32_t n : touching) add<false>(job.triangles[n], job, band);
    }
    if (!touched) {
        std::fill_n(out.length_mm.values.data() + offset, pixels, 0.0F);
        return;
    }
    if (job.with_values) band.sort_crossings();
    for (std::size_t n = 0; n < pixels; ++n) {
        const bool bad = band.exits[n] != 0.0F;
        band.bad += bad ? 1 : 0;
        float length = 0.0F;
        if (band.depth[n] != 0.0F && !bad) {
            // From depth along the normal to distance along the ray.
            const double sx = slope_x_[n % width], sy = slope_y_[static_cast<std::size_t>(band.begin) + n / width];
            const double slant = std::sqrt(1.0 + sx * sx + sy * sy);
            length = static_cast<float>(band.depth[n] * slant);
            if (job.with_values && length > 1e-3F)
                out.contrast_mm_mg_ml.values[offset + n] = static_cast<float>(slant) * band.integral(n);
        }
        out.length_mm.values[offset + n] = length;
    }
}

void PathRaster::draw(const Projection& projection, std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                      std::span<const double> values, PathLengths& out, std::span<const double> widths) {
    CATHLAB_CHECK(values.empty() || values.size() == vertices.size(), "one value a vertex");
    CATHLAB_CHECK(widths.empty() || widths.size() == vertices.size(), "one width a vertex");
    const bool with_values = std::any_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
    width_ = projection.width();
    height_ = projection.height();
    mirrored_ = projection.mirrored();
    reference_ = 0.65 * projection.source_detector_mm();
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    project(projection, vertices);
    sort_into_bands(triangles);
    out.length_mm.width = out.contrast_mm_mg_ml.width = width_;
    out.length_mm.height = out.contrast_mm_mg_ml.height = height_;
    out.length_mm.values.resize(count);
    out.contrast_mm_mg_ml.values.assign(with_values ? count : 0, 0.0F);
    const Job job{triangles, values, widths, with_values};
    workers_.for_ranges(bands_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) draw_band(i, job, out);
    });
    out.bad_pixels = 0;
    for (const Band& band : bands_) out.bad_pixels += band.bad;
}

}  // namespace cathlab
