#include "render/subtraction.h"

#include <algorithm>

#include "render/detector.h"

namespace cathlab {
namespace {

constexpr double roadmap_blur_px = 1.0;    // evens out the noise, of which a maximum would take the peaks
constexpr double noise_after_blur = 0.28;  // 1 / (2 sqrt(pi) sigma) of white noise
constexpr double noises_left_out = 4.0;
constexpr float brightest = 0.9F;  // of the roadmap, ln: an aorta full of medium would whiten the picture

bool same_size(const ImageF& a, const ImageF& b) {
    return a.width == b.width && a.height == b.height;
}

}  // namespace

void Subtraction::begin(std::uint64_t series) {
    series_ = series;
    masked_ = 0;
    collecting_ = false;
    mask_ = {};
}

void Subtraction::forget() {
    begin(series_);
    roadmap_ = {};
}

void Subtraction::add(const ImageF& ln, bool collected, double noise, const Workers& workers) {
    if (!same_size(mask_, ln)) {
        mask_ = ImageF(ln.width, ln.height);
        masked_ = 0;
    }
    if (masked_ < mask_frames) {
        ++masked_;
        const float share = 1.0F / static_cast<float>(masked_);
        for (std::size_t i = 0; i < ln.values.size(); ++i) mask_.values[i] += share * (ln.values[i] - mask_.values[i]);
        return;
    }
    if (!collected) return;
    if (!collecting_) roadmap_ = ImageF(ln.width, ln.height);
    collecting_ = true;
    ImageF shadow(ln.width, ln.height);
    for (std::size_t i = 0; i < ln.values.size(); ++i) shadow.values[i] = mask_.values[i] - ln.values[i];
    blur(shadow, roadmap_blur_px, workers);
    const auto left_out = static_cast<float>(noises_left_out * noise_after_blur * noise);
    for (std::size_t i = 0; i < ln.values.size(); ++i)
        roadmap_.values[i] = std::max(roadmap_.values[i], std::min(shadow.values[i] - left_out, brightest));
}

void Subtraction::subtract(ImageF& ln) const {
    if (!has_mask() || !same_size(mask_, ln)) return;
    for (std::size_t i = 0; i < ln.values.size(); ++i) ln.values[i] -= mask_.values[i];
}

void Subtraction::lay_roadmap(ImageF& ln, double share) const {
    if (!same_size(roadmap_, ln)) return;
    const auto part = static_cast<float>(share);
    for (std::size_t i = 0; i < ln.values.size(); ++i) ln.values[i] += part * roadmap_.values[i];
}

}  // namespace cathlab
