// Digital subtraction and roadmap: what is made of the logarithms of a series of pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "imaging/image.h"

namespace cathlab {

/// A mask is the mean of the first mask_frames logarithms of a series; a subtracted picture is the logarithm less the
/// mask, so that what stands still vanishes and what came since is darker by its own attenuation alone.  The roadmap
/// keeps, pixel by pixel, the deepest shadow that the medium threw in a series (its peak opacification).
class Subtraction {
public:
    static constexpr int mask_frames = 3;

    /// Another series begins: its mask is made anew.  The roadmap stays until medium is seen again.
    void begin(std::uint64_t series);
    /// Another place of source or detector: neither mask nor roadmap fits any more.
    void forget();
    std::uint64_t series() const { return series_; }

    /// Takes the next picture of the series.  collected: deeper shadows than before join the roadmap; noise is the
    /// standard deviation of ln, of which four times is left out.
    void add(const ImageF& ln, bool collected, double noise, const Workers& workers);
    /// Whether the series' mask is complete.
    bool has_mask() const { return masked_ >= mask_frames; }
    /// ln -= mask; nothing without a mask.
    void subtract(ImageF& ln) const;

    bool has_roadmap() const { return !roadmap_.values.empty(); }
    /// ln += share of the roadmap: vessels become bright, and what lies in them stays dark.
    void lay_roadmap(ImageF& ln, double share) const;

private:
    std::uint64_t series_ = 0;
    int masked_ = 0;
    bool collecting_ = false;
    ImageF mask_, roadmap_;
};

}  // namespace cathlab
