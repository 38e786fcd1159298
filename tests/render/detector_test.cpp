#include "render/detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/fast_math.h"

namespace cathlab {
namespace {

std::pair<double, double> mean_and_variance(const ImageF& image) {
    double sum = 0, squares = 0;
    for (const float v : image.values) sum += v;
    const double mean = sum / static_cast<double>(image.values.size());
    for (const float v : image.values) squares += (v - mean) * (v - mean);
    return {mean, squares / static_cast<double>(image.values.size() - 1)};
}

TEST(QuantumNoise, VarianceEqualsMean) {
    for (const float photons : {30.0F, 160.0F, 900.0F}) {
        ImageF image(512, 512, photons);
        add_quantum_noise(image, 5, 17, Workers());
        const auto [mean, variance] = mean_and_variance(image);
        EXPECT_NEAR(mean / photons, 1.0, 0.002);
        EXPECT_NEAR(variance / photons, 1.0, 0.02);
    }
}

TEST(QuantumNoise, IsAPureFunctionOfSeedFrameAndPixel) {
    ImageF a(64, 64, 100.0F), b(64, 64, 100.0F), other_frame(64, 64, 100.0F), other_seed(64, 64, 100.0F);
    add_quantum_noise(a, 5, 17, Workers(1));
    add_quantum_noise(b, 5, 17, Workers(3));
    add_quantum_noise(other_frame, 5, 18, Workers());
    add_quantum_noise(other_seed, 6, 17, Workers());
    EXPECT_EQ(a.values, b.values);
    double with_frame = 0, with_seed = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        with_frame += (a.values[i] - 100) * (other_frame.values[i] - 100);
        with_seed += (a.values[i] - 100) * (other_seed.values[i] - 100);
    }
    EXPECT_LT(std::fabs(with_frame) / 4096 / 100, 0.06);  // four standard errors
    EXPECT_LT(std::fabs(with_seed) / 4096 / 100, 0.06);
}

TEST(Recursion, DividesTheNoiseBySquareRootOfOnePlusBOverOneMinusB) {
    for (const double b : {0.5, 0.67, 0.8}) {
        ImageF history;
        for (std::uint64_t frame = 0; frame < 40; ++frame) {
            ImageF image(256, 256, 400.0F);
            add_quantum_noise(image, 1, frame, Workers());
            recurse(history, image, b, Workers());
        }
        const double ratio = std::sqrt(mean_and_variance(history).second) / 20.0;
        EXPECT_NEAR(ratio / std::sqrt((1 - b) / (1 + b)), 1.0, 0.02) << b;
    }
}

TEST(Blur, KeepsTheSumAndHasItsSigma) {
    ImageF image(65, 65);
    image.values[image.offset(32, 32)] = 1000.0F;
    blur(image, 2.0, Workers());
    double sum = 0, second = 0;
    for (int y = 0; y < 65; ++y) {
        for (int x = 0; x < 65; ++x) {
            sum += image.at(x, y);
            second += static_cast<double>(image.at(x, y)) * (x - 32) * (x - 32);
        }
    }
    EXPECT_NEAR(sum, 1000.0, 0.01);
    EXPECT_NEAR(std::sqrt(second / sum), 2.0, 0.06);
    ImageF flat(40, 30, 7.0F);
    blur(flat, 1.5, Workers());
    for (const float v : flat.values) EXPECT_NEAR(v, 7.0F, 1e-5);
}

TEST(WideBlur, KeepsAFlatPictureAndSmoothsAnEdge) {
    for (const float v : wide_blur(ImageF(100, 80, 3.0F), 20).values) EXPECT_NEAR(v, 3.0F, 1e-4);
    ImageF edge(200, 100);
    for (int y = 0; y < 100; ++y) {
        for (int x = 100; x < 200; ++x) edge.values[edge.offset(x, y)] = 1.0F;
    }
    const ImageF smooth = wide_blur(edge, 20);
    EXPECT_NEAR(smooth.at(100, 50), 0.5, 0.03);
    EXPECT_NEAR(smooth.at(120, 50), 0.841, 0.03);  // normal distribution at one sigma
}

TEST(FastMath, ExpAndLogAgreeWithTheLibrary) {
    for (double x = -20; x < 20; x += 0.0137) {
        const auto f = static_cast<float>(x);
        EXPECT_NEAR(fast_exp(f) / std::exp(static_cast<double>(f)), 1.0, 3e-6);
        EXPECT_NEAR(fast_log(static_cast<float>(std::exp(x))), x, 4e-6 * (1 + std::fabs(x)));
    }
}

}  // namespace
}  // namespace cathlab
