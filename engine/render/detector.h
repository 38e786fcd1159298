// From the intensity at the detector to grey: quantum noise, scintillator blur, electronic noise, recursion, display.
#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "imaging/image.h"

namespace cathlab {

/// Approximately normal number with mean 0 and variance 1, a pure function of its key: the sum of four 16-bit uniforms
/// (Irwin-Hall; excess kurtosis -0.3, |value| < 3.47), cheap enough for every pixel of every frame.
float pixel_noise(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel, std::uint64_t stream);

/// photons -> photons + sqrt(photons) * noise, not below 0: Poisson's mean and variance.  Before the blur, since quanta
/// arrive independently and the scintillator spreads each of them.
void add_quantum_noise(ImageF& photons, std::uint64_t seed, std::uint64_t frame, const Workers& workers);

/// Independent noise of the read-out with standard deviation sigma (in photons).
void add_electronic_noise(ImageF& photons, double sigma, std::uint64_t seed, std::uint64_t frame,
                          const Workers& workers);

/// Separable Gaussian of sigma pixels: its transfer function along rows and columns is exp(-2 pi^2 sigma^2 f^2) up to
/// the Nyquist frequency (taps of sum 1, radius max(5, ceil(3 sigma))); edges repeat.  sigma < 0.15 does nothing.
void blur(ImageF& image, double sigma_px, const Workers& workers);

/// The same for one picture after another: keeps its taps and its memory.
class GaussianBlur {
public:
    void apply(ImageF& image, double sigma_px, const Workers& workers);

private:
    double sigma_px_ = -1.0;
    std::vector<float> kernel_;
    std::vector<float> across_;  // blurred along the rows
};

/// y = (1 - b) x + b y'.  An empty or differently sized history takes x.  For independent noise the standard deviation
/// falls to sqrt((1 - b) / (1 + b)).  b in [0, 1).
void recurse(ImageF& history, const ImageF& x, double b, const Workers& workers);

/// A wide blur of sigma_px pixels made on a coarse grid (for scatter and for harmonisation: sigma of tens of pixels).
ImageF wide_blur(const ImageF& image, double sigma_px, const Workers& workers = Workers());

}  // namespace cathlab
