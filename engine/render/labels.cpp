#include "render/labels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "render/attenuation.h"
#include "render/device_chords.h"
#include "render/image_intensifier.h"
#include "render/projection.h"
#include "render/shutter.h"
#include "render/view_key.h"

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
        std::vector<std::uint8_t>& visible = masks[static_cast<std::size_t>(region)].visible;
        visible.resize(count);
        if (lumen.contrast_mg_ml.empty()) continue;
        double medium = 0.0;
        for (int k = 0; k < 3; ++k) medium += lumen.contrast_mg_ml[static_cast<std::size_t>(t[k])] / 3.0;
        if (medium > source.seen_mg_ml) fill(at(0), at(1), at(2), projection.width(), projection.height(), visible);
    }
    for (std::size_t r = 0; r < masks.size(); ++r) masks[r].name = source.region_names[r];
    std::erase_if(masks, [](const FrameLabels::Mask& m) {
        return std::find(m.inside.begin(), m.inside.end(), std::uint8_t{1}) == m.inside.end();
    });
    return masks;
}

// Attenuation of a device's materials beyond what they displace, of the detector's whole signal, 1/mm.
std::vector<double> device_mu(const FrameDevice& device, const BeamTable& beam) {
    std::vector<double> out;
    const BinValues outside = beam.attenuation(device.surrounding);
    for (const std::string& material : device.materials) {
        const BinValues inside = beam.attenuation(material);
        double mu = 0.0;
        for (std::size_t k = 0; k < energy_bins; ++k)
            mu += static_cast<double>(beam.weights()[k]) * static_cast<double>(inside[k] - outside[k]);
        out.push_back(mu);
    }
    return out;
}

std::vector<FrameLabels::Mask> device_masks(const FrameDescription& frame, const Projection& projection,
                                            const Workers& workers) {
    const std::vector<FrameDevice>& devices = frame.devices;
    std::vector<ChordPiece> pieces;
    std::vector<FrameLabels::Mask> masks;
    std::vector<double> mu;  // one a medium; a device's media lie together
    std::vector<std::size_t> device_of;
    const std::size_t count =
        static_cast<std::size_t>(projection.width()) * static_cast<std::size_t>(projection.height());
    const BeamTable beam(generator_kvp(frame.exposure), frame.exposure.copper_mm);
    for (std::size_t i = 0; i < devices.size(); ++i) {
        std::vector<std::uint8_t> medium_of;
        for (const double value : device_mu(devices[i], beam)) {
            medium_of.push_back(static_cast<std::uint8_t>(mu.size()));
            mu.push_back(value);
            device_of.push_back(i);
        }
        append_pieces(devices[i], medium_of, pieces);
        masks.push_back({devices[i].name, std::vector<std::uint8_t>(count), std::vector<std::uint8_t>(count)});
    }
    if (devices.empty()) return masks;
    DeviceLengths drawn;
    draw_devices(pieces, static_cast<int>(mu.size()), projection, rays_a_side, workers, drawn);
    std::vector<double> shadow(devices.size());
    for (std::size_t n = 0; n < drawn.pixel.size(); ++n) {
        std::fill(shadow.begin(), shadow.end(), 0.0);
        for (std::size_t m = 0; m < mu.size(); ++m) {
            const auto length = static_cast<double>(drawn.length_mm[n * mu.size() + m]);
            if (length <= 0.0) continue;
            masks[device_of[m]].inside[drawn.pixel[n]] = 1;
            shadow[device_of[m]] += mu[m] * length;
        }
        const auto deepest = std::max_element(shadow.begin(), shadow.end());
        if (*deepest > 0.0) masks[static_cast<std::size_t>(deepest - shadow.begin())].visible[drawn.pixel[n]] = 1;
    }
    return masks;
}

// What blades shade, and of a vessel what a device covers, is not to be seen.
void hide(FrameLabels& labels, const CArmView& view) {
    const auto columns = static_cast<std::size_t>(labels.width);
    const bool shaded = view.open_width < 1.0 || view.open_height < 1.0;
    for (std::vector<FrameLabels::Mask>* masks : {&labels.devices, &labels.regions}) {
        for (FrameLabels::Mask& mask : *masks) {
            for (std::size_t i = 0; i < mask.visible.size(); ++i) {
                if (mask.visible[i] == 0) continue;
                if (shaded && !(is_open(static_cast<double>(i % columns) + 0.5, labels.width, view.open_width) &&
                                is_open(static_cast<double>(i / columns) + 0.5, labels.height, view.open_height)))
                    mask.visible[i] = 0;
                for (const FrameLabels::Mask& device : labels.devices)
                    if (masks == &labels.regions && device.inside[i] != 0) mask.visible[i] = 0;
            }
        }
    }
}

// Masks as an image intensifier shows them.
void bend(std::vector<FrameLabels::Mask>& masks, const FrameDetector& detector, int width, int height) {
    const Pincushion bent(detector.pincushion, width, height);
    if (bent.none() && !detector.round_field) return;
    const Vec2 middle(0.5 * width, 0.5 * height);
    const double radius = detector.round_field ? 0.5 * std::min(width, height) : 1e18;
    const auto bend_one = [&](std::vector<std::uint8_t>& inside) {
        const std::vector<std::uint8_t> flat = inside;
        std::size_t i = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x, ++i) {
                const Vec2 here(x + 0.5, y + 0.5);
                const Vec2 from = bent.pinhole(here);
                const bool out = (here - middle).norm() > radius || from.x() < 0 || from.y() < 0 || from.x() >= width ||
                                 from.y() >= height;
                inside[i] = out ? std::uint8_t{0}
                                : flat[static_cast<std::size_t>(from.y()) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(from.x())];
            }
        }
    };
    for (FrameLabels::Mask& mask : masks) {
        bend_one(mask.inside);
        bend_one(mask.visible);
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
    out.devices = device_masks(frame, projection, workers);
    out.regions = region_masks(frame.lumen, source, projection);
    bend(out.devices, detector, width, height);
    bend(out.regions, detector, width, height);
    hide(out, frame.view);
    for (const LabelSource::Point& p : source.points) {
        FrameLabels::Point point{p.name, p.position, place(p.position), 0};
        const bool open = is_open(point.pixel.x(), width, frame.view.open_width) &&
                          is_open(point.pixel.y(), height, frame.view.open_height);
        if (in_picture(point.world, point.pixel)) point.visibility = p.seen && open ? 2 : 1;
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
