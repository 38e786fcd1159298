#include "render/image_intensifier.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "render/detector.h"

namespace cathlab {

FrameDetector detector_preset(const std::string& name) {
    FrameDetector out;
    if (name == "flat_panel") return out;
    if (name == "image_intensifier") {
        out.blur_sigma_mm =
            0.25;  // a tenth of the modulation left at 1.4 line pairs a mm of a 300 mm field (an assumption)
        out.electronic_noise_photons = 4.0;
        out.glare = 0.08;  // contrast ratio of about 12 behind a wide lead disc
        out.pincushion = 0.04;
        out.round_field = true;
        return out;
    }
    throw UserError("there is no detector '" + name + "'" + did_you_mean(name, {"flat_panel", "image_intensifier"}) +
                    "; known are flat_panel and image_intensifier");
}

Pincushion::Pincushion(double k, int width, int height)
    : k_(k), radius_(0.5 * std::min(width, height)), middle_(0.5 * width, 0.5 * height) {}

Vec2 Pincushion::shown(const Vec2& pinhole) const {
    const Vec2 from = pinhole - middle_;
    return middle_ + from * (1.0 + k_ * from.squaredNorm() / (radius_ * radius_));
}

Vec2 Pincushion::pinhole(const Vec2& shown) const {
    const Vec2 from = shown - middle_;
    const double wanted = from.norm() / radius_;
    if (wanted < 1e-12) return shown;
    double r = wanted;  // r (1 + k r^2) = wanted, by Newton
    for (int i = 0; i < 6; ++i) r -= (r * (1.0 + k_ * r * r) - wanted) / (1.0 + 3.0 * k_ * r * r);
    return middle_ + from * (r / wanted);
}

void distort(ImageF& image, const FrameDetector& detector, double pixel_mm, const Workers& workers) {
    if (detector.glare > 0.0) {
        const ImageF veil = wide_blur(image, detector.glare_sigma_mm / pixel_mm, workers);
        const auto share = static_cast<float>(detector.glare);
        for (std::size_t i = 0; i < image.values.size(); ++i)
            image.values[i] += share * (veil.values[i] - image.values[i]);
    }
    const Pincushion bent(detector.pincushion, image.width, image.height);
    if (bent.none() && !detector.round_field) return;
    const ImageF flat = image;
    const double radius = 0.5 * std::min(image.width, image.height);
    const Vec2 middle(0.5 * image.width, 0.5 * image.height);
    workers.for_ranges(static_cast<std::size_t>(image.height), 32, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < image.width; ++x) {
                const Vec2 here(x + 0.5, y + 0.5);
                float& out = image.values[image.offset(x, y)];
                if (detector.round_field && (here - middle).norm() > radius) {
                    out = 0.0F;
                    continue;
                }
                const Vec2 from = bent.pinhole(here) - Vec2(0.5, 0.5);
                const double fx = std::clamp(from.x(), 0.0, image.width - 1.0);
                const double fy = std::clamp(from.y(), 0.0, image.height - 1.0);
                const int x0 = std::min(static_cast<int>(fx), image.width - 2);
                const int y0 = std::min(static_cast<int>(fy), image.height - 2);
                const auto tx = static_cast<float>(fx - x0), ty = static_cast<float>(fy - y0);
                const float top = flat.at(x0, y0) + tx * (flat.at(x0 + 1, y0) - flat.at(x0, y0));
                const float low = flat.at(x0, y0 + 1) + tx * (flat.at(x0 + 1, y0 + 1) - flat.at(x0, y0 + 1));
                out = top + ty * (low - top);
            }
        }
    });
}

}  // namespace cathlab
