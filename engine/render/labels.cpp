#include "render/labels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "render/device_chords.h"
#include "render/image_intensifier.h"
#include "render/projection.h"

namespace cathlab {

namespace {

constexpr int rays_a_side = 3;  // of a pixel, as the picture is drawn

// Marks the pixels whose centres lie in the triangle.
void fill(const Vec2& a, const Vec2& b, const Vec2& c, int width, int height, std::vector<std::uint8_t>& inside) {
    const double top = std::min({a.y(), b.y(), c.y()}), bottom = std::max({a.y(), b.y(), c.y()});
    const int first = static_cast<int>(std::ceil(std::clamp(top - 0.5, 0.0, static_cast<double>(height))));
    const int last = static_cast<int>(std::ceil(std::clamp(bottom - 0.5, 0.0, static_cast<double>(height))));
    for (int row = first; row < last; ++row) {
        const double y = row + 0.5;
        double left = 1e18, right = -1e18;
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            if ((p.y() <= y) == (q.y() <= y)) continue;
            const double x = p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
            left = std::min(left, x);
            right = std::max(right, x);
        }
        const auto from = static_cast<std::size_t>(std::ceil(std::clamp(left - 0.5, 0.0, static_cast<double>(width))));
        const auto to = static_cast<std::size_t>(std::ceil(std::clamp(right - 0.5, 0.0, static_cast<double>(width))));
        const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
        for (std::size_t x = from; x < to; ++x) inside[start + x] = 1;
    }
}

std::vector<FrameLabels::Mask> region_masks(const FrameLumen& lumen, const LabelSource& source,
                                            const Projection& projection) {
    if (source.region.empty()) return {};
    CATHLAB_CHECK(source.region.size() == lumen.vertices.size(), "one region a vertex of the lumen");
    const std::size_t count =
        static_cast<std::size_t>(projection.width()) * static_cast<std::size_t>(projection.height());
    std::vector<Vec2> places;
    places.reserve(lumen.vertices.size());
    for (const Vec3& v : lumen.vertices) places.push_back(projection.pixel(v));
    std::vector<FrameLabels::Mask> masks(source.region_names.size());
    for (const Triangle& t : lumen.triangles) {
        const auto of = [&](int k) { return source.region[static_cast<std::size_t>(t[k])]; };
        const Index region = of(1) == of(2) ? of(1) : of(0);  // what two of the three corners belong to
        std::vector<std::uint8_t>& inside = masks[static_cast<std::size_t>(region)].inside;
        inside.resize(count);
        const auto at = [&](int k) { return places[static_cast<std::size_t>(t[k])]; };
        fill(at(0), at(1), at(2), projection.width(), projection.height(), inside);
    }
    for (std::size_t r = 0; r < masks.size(); ++r) masks[r].name = source.region_names[r];
    std::erase_if(masks, [](const FrameLabels::Mask& m) {
        return std::find(m.inside.begin(), m.inside.end(), std::uint8_t{1}) == m.inside.end();
    });
    return masks;
}

std::vector<FrameLabels::Mask> device_masks(const std::vector<FrameDevice>& devices, const Projection& projection,
                                            const Workers& workers) {
    std::vector<ChordPiece> pieces;
    std::vector<FrameLabels::Mask> masks;
    const std::size_t count =
        static_cast<std::size_t>(projection.width()) * static_cast<std::size_t>(projection.height());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        append_pieces(devices[i], std::vector<std::uint8_t>(devices[i].materials.size(), static_cast<std::uint8_t>(i)),
                      pieces);
        masks.push_back({devices[i].name, std::vector<std::uint8_t>(count)});
    }
    DeviceLengths drawn;
    draw_devices(pieces, static_cast<int>(devices.size()), projection, rays_a_side, workers, drawn);
    for (std::size_t n = 0; n < drawn.pixel.size(); ++n) {
        for (std::size_t i = 0; i < devices.size(); ++i) {
            if (drawn.length_mm[n * devices.size() + i] > 0.0F) masks[i].inside[drawn.pixel[n]] = 1;
        }
    }
    return masks;
}

// Masks as an image intensifier shows them.
void bend(std::vector<FrameLabels::Mask>& masks, const FrameDetector& detector, int width, int height) {
    const Pincushion bent(detector.pincushion, width, height);
    if (bent.none() && !detector.round_field) return;
    const Vec2 middle(0.5 * width, 0.5 * height);
    const double radius = detector.round_field ? 0.5 * std::min(width, height) : 1e18;
    for (FrameLabels::Mask& mask : masks) {
        const std::vector<std::uint8_t> flat = mask.inside;
        std::size_t i = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x, ++i) {
                const Vec2 here(x + 0.5, y + 0.5);
                const Vec2 from = bent.pinhole(here);
                const bool out = (here - middle).norm() > radius || from.x() < 0 || from.y() < 0 || from.x() >= width ||
                                 from.y() >= height;
                mask.inside[i] = out ? std::uint8_t{0}
                                     : flat[static_cast<std::size_t>(from.y()) * static_cast<std::size_t>(width) +
                                            static_cast<std::size_t>(from.x())];
            }
        }
    }
}

std::array<double, 12> camera_matrix(const CArmView& view, const Projection& projection) {
    const Vec3 center = view.detector_center - view.source;
    const double sid = projection.source_detector_mm();
    const Vec3& n = projection.normal();
    const double per_x = projection.width() / view.width_mm, per_y = projection.height() / view.height_mm;
    const Vec3 column = per_x * (sid * view.right - center.dot(view.right) * n) + 0.5 * projection.width() * n;
    const Vec3 row = per_y * (sid * view.down - center.dot(view.down) * n) + 0.5 * projection.height() * n;
    std::array<double, 12> out{};
    std::size_t i = 0;
    for (const Vec3& line : {column, row, n}) {
        for (int k = 0; k < 3; ++k) out[i++] = line[k];
        out[i++] = -line.dot(view.source);
    }
    return out;
}

}  // namespace

FrameLabels label_frame(const FrameDescription& frame, const LabelSource& source, int width, int height,
                        const Workers& workers) {
    const Projection projection(frame.view, width, height);
    const FrameDetector& detector = frame.exposure.detector;
    const Pincushion bent(detector.pincushion, width, height);
    const auto place = [&](const Vec3& p) {
        const Vec2 pinhole = projection.pixel(p);
        return bent.none() ? pinhole : bent.shown(pinhole);
    };
    const auto in_picture = [&](const Vec3& world, const Vec2& pixel) {
        if (projection.depth(world) <= 0) return false;
        if (detector.round_field && (pixel - 0.5 * Vec2(width, height)).norm() > 0.5 * std::min(width, height))
            return false;
        return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width && pixel.y() < height;
    };
    FrameLabels out;
    out.width = width;
    out.height = height;
    out.devices = device_masks(frame.devices, projection, workers);
    out.regions = region_masks(frame.lumen, source, projection);
    bend(out.devices, detector, width, height);
    bend(out.regions, detector, width, height);
    for (const LabelSource::Point& p : source.points) {
        FrameLabels::Point point{p.name, p.position, place(p.position), 0};
        if (in_picture(point.world, point.pixel)) point.visibility = p.seen ? 2 : 1;
        out.points.push_back(std::move(point));
    }
    for (const FrameDevice& device : frame.devices) {
        FrameLabels::Line line{device.name, device.points, {}};
        for (const Vec3& p : device.points) line.pixels.push_back(place(p));
        out.lines.push_back(std::move(line));
    }
    out.camera = camera_matrix(frame.view, projection);
    return out;
}

}  // namespace cathlab
