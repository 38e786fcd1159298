#include "render/detector.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "render/fast_math.h"
#include "render/pixel_loops.h"

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

TEST(QuantumNoise, NeighboursKnowNothingOfEachOther) {
    ImageF image(512, 512, 400.0F);
    add_quantum_noise(image, 3, 8, Workers());
    for (const int step : {1, 2, 511, 512, 513, 1024, 65536}) {
        double sum = 0;
        std::size_t pairs = 0;
        for (std::size_t i = 0; i + static_cast<std::size_t>(step) < image.values.size(); ++i, ++pairs)
            sum += (image.values[i] - 400) * (image.values[i + static_cast<std::size_t>(step)] - 400);
        EXPECT_LT(std::fabs(sum / 400 / std::sqrt(static_cast<double>(pairs))), 4.0) << step;  // standard errors
    }
}

TEST(PixelLoops, EveryInstructionSetGivesTheSameValues) {
    const pixel_loops::Set* wide = pixel_loops::avx2();
    if (wide == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    const pixel_loops::Set& plain = pixel_loops::baseline();
    constexpr std::size_t count = 1003;
    std::vector<float> transmission(8 * count), amount(count), more(count), zero(count);
    for (std::size_t i = 0; i < count; ++i) {
        amount[i] = i % 3 == 0 ? 0.0F : 0.07F * static_cast<float>(i % 301);
        more[i] = i % 5 == 0 ? 0.3F : 0.0F;
    }
    for (std::size_t i = 0; i < transmission.size(); ++i)
        transmission[i] = 0.01F + 0.001F * static_cast<float>(i * 7919 % 131);
    std::vector<double> slope(count);
    for (std::size_t i = 0; i < count; ++i) slope[i] = -0.15 + 0.3 * static_cast<double>(i) / count;
    const std::vector<float> mu{0.05F, 0.04F, 0.03F, 0.025F, 0.02F, 0.018F, 0.017F, 0.016F};
    const std::array<pixel_loops::Absorber, 2> absorbers{{{amount.data(), mu.data()}, {more.data(), mu.data()}}};
    const auto run = [&](const pixel_loops::Set& set) {
        std::vector<float> out(count), logs(count);
        set.absorb(absorbers.data(), 2, transmission.data(), amount.data(), more.data(), 1, count - 1, out.data());
        for (float& v : out) v *= 200.0F;
        set.quantum_noise(77, 5, count, out.data());
        set.electronic_noise(78, 2.0F, 5, count, out.data());
        set.to_log(out.data(), more.data(), 0.02F, 0.7F, 0.1F, count, logs.data());
        std::vector<std::uint8_t> grey(count - 2);
        set.sharpen(logs.data(), zero.data(), zero.data(), 0.1F, 127.0F, 150.0F, count - 2, grey.data());
        set.attenuate(transmission.data(), count, out.data());
        std::vector<float> depth(count), exits(count), passed(8 * count), context(count), blurred(count - 6);
        set.add_depths(slope.data(), count, {0.0031, 0.0012, 0.0011, 0.0018, 650.0, -1.0F}, depth.data(), exits.data());
        set.pass_context(absorbers.data(), 2, mu.data(), amount.data(), 1, count, passed.data(), context.data());
        const std::array<const float*, 6> taps{amount.data(),     amount.data() + 1, amount.data() + 2,
                                               amount.data() + 3, more.data() + 4,   more.data() + 5};
        set.weigh(taps.data(), mu.data(), taps.size(), blurred.size(), blurred.data());
        return std::tuple(out, logs, grey, depth, exits, passed, context, blurred);
    };
    EXPECT_TRUE(run(plain) == run(*wide));
}

TEST(PixelLoops, AbsorptionIsTheSumOfTheBinsExponentials) {
    const std::vector<float> transmission{0.1F, 0.2F, 0.05F, 0.15F, 0.2F, 0.1F, 0.1F, 0.1F},
        mu{0.05F, 0.04F, 0.03F, 0.025F, 0.02F, 0.018F, 0.017F, 0.016F};
    for (const float amount : {0.5F, 30.0F, 900.0F, -4.0F}) {
        const float untouched = 1.0F, scatter = 0.25F;
        const pixel_loops::Absorber absorber{&amount, mu.data()};
        float out = 0;
        pixel_loops::best().absorb(&absorber, 1, transmission.data(), &untouched, &scatter, 0, 1, &out);
        double truth = 0.25;
        for (std::size_t k = 0; k < 8; ++k) truth += transmission[k] * std::exp(-static_cast<double>(mu[k]) * amount);
        EXPECT_NEAR(out / truth, 1.0, 1e-6) << amount;
    }
}

TEST(FastMath, ExpAndLogAgreeWithTheLibrary) {
    for (int i = -1460; i < 1460; ++i) {
        const double x = 0.0137 * i;
        const auto f = static_cast<float>(x);
        EXPECT_NEAR(fast_exp(f) / std::exp(static_cast<double>(f)), 1.0, 3e-6);
        EXPECT_NEAR(fast_log(static_cast<float>(std::exp(x))), x, 4e-6 * (1 + std::fabs(x)));
    }
}

}  // namespace
}  // namespace cathlab
