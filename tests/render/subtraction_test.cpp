#include "render/subtraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/attenuation.h"
#include "render/frame_renderer.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

ImageF flat(float value) {
    ImageF out(32, 32);
    for (float& v : out.values) v = value;
    return out;
}

TEST(Subtraction, TheMaskIsTheMeanOfTheFirstPictures) {
    Subtraction subtraction;
    subtraction.begin(1);
    const Workers workers;
    for (const float value : {-1.0F, -1.2F, -1.4F}) {
        EXPECT_FALSE(subtraction.has_mask());
        subtraction.add(flat(value), false, 0.0, workers);
    }
    ASSERT_TRUE(subtraction.has_mask());
    ImageF now = flat(-2.0F);
    subtraction.subtract(now);
    EXPECT_NEAR(now.at(5, 7), -0.8, 1e-6);
    subtraction.begin(2);  // another series: without a mask nothing is taken off
    EXPECT_FALSE(subtraction.has_mask());
    now = flat(-2.0F);
    subtraction.subtract(now);
    EXPECT_EQ(now.at(5, 7), -2.0F);
}

TEST(Subtraction, TheRoadmapIsTheDeepestShadowAndOutlivesItsSeries) {
    Subtraction subtraction;
    const Workers workers;
    subtraction.begin(1);
    for (int i = 0; i < 3; ++i) subtraction.add(flat(-1.0F), true, 0.0, workers);
    for (const float value : {-1.1F, -1.5F, -1.2F}) subtraction.add(flat(value), true, 0.0, workers);
    subtraction.begin(2);
    ASSERT_TRUE(subtraction.has_roadmap());
    ImageF live = flat(-1.0F);
    subtraction.lay_roadmap(live, 1.0);
    EXPECT_NEAR(live.at(9, 9), -0.5, 1e-5);
    // A series without medium leaves it, one with medium replaces it, and another view has none.
    for (int i = 0; i < 5; ++i) subtraction.add(flat(-3.0F), false, 0.0, workers);
    live = flat(-1.0F);
    subtraction.lay_roadmap(live, 1.0);
    EXPECT_NEAR(live.at(9, 9), -0.5, 1e-5);
    subtraction.forget();
    EXPECT_FALSE(subtraction.has_roadmap());
}

TEST(Subtraction, NoiseAloneMakesNoRoadmap) {
    Subtraction subtraction;
    const Workers workers;
    subtraction.begin(1);
    const double noise = 0.05;
    ImageF last;
    for (std::uint64_t frame = 0; frame < 40; ++frame) {
        last = ImageF(128, 128);
        for (std::size_t i = 0; i < last.values.size(); ++i) {
            // Box-Muller from the core's mixing would do as well; a golden-ratio sequence has the same width.
            const double u = std::fmod(0.5 + 0.6180339887 * static_cast<double>(i * 41 + frame * 7919), 1.0);
            last.values[i] = static_cast<float>(noise * std::sqrt(12.0) * (u - 0.5));
        }
        subtraction.add(last, true, noise, workers);
    }
    ImageF live(128, 128);
    subtraction.lay_roadmap(live, 1.0);
    double largest = 0;
    for (const float v : live.values) largest = std::max(largest, static_cast<double>(std::fabs(v)));
    EXPECT_LT(largest, 0.6 * noise);
}

// A patient of 200 mm of water with a vessel of 20 mm across the picture.
FrameDescription patient() {
    FrameDescription f;
    f.width = f.height = 128;
    f.show_inner_view = false;
    f.view = view(0, 100);
    f.exposure.scatter_to_primary = 0;
    f.exposure.detector_kerma_ngy = 1e7;  // without noise to speak of
    f.exposure.edge_enhancement = 0;
    f.exposure.detector.electronic_noise_photons = 0;
    FrameSolid slab;
    slab.material = "water";
    slab.surrounding = "air";
    slab.mesh = box({-300, -100, -300}, {300, 100, 300});
    f.solids.push_back(slab);
    const TriMesh tube = cylinder(Vec3::Zero(), 10, 120, 96);
    f.lumen.vertices = tube.vertices;
    f.lumen.triangles = tube.triangles;
    f.lumen.surrounding = "water";
    f.series.number = 1;
    f.series.collected = true;
    return f;
}

TEST(Subtraction, ASubtractedPictureShowsTheMediumAlone) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f = patient();
    f.series.subtracted = true;
    Image8 out;
    const auto grey = [&](int x, int y) { return static_cast<double>(out.rgb[out.offset(x, y)]); };
    for (int i = 0; i < 4; ++i, ++f.frame_index) renderer.render(f, out);
    const double still = grey(20, 64);
    for (int x = 8; x < 120; x += 4) EXPECT_NEAR(grey(x, 64), still, 1.0) << "what stands still is gone, column " << x;

    f.lumen.contrast_mg_ml.assign(f.lumen.vertices.size(), 20.0);
    renderer.render(f, out);
    EXPECT_NEAR(grey(20, 64), still, 1.0);
    // Beer-Lambert through the middle of the tube: 20 mm of 20 mg/mL behind the patient, in the beam's bins.
    const BeamTable beam(f.exposure.kvp, f.exposure.copper_mm);
    double before = 0, after = 0;
    for (std::size_t k = 0; k < energy_bins; ++k) {
        const double water = beam.attenuation("water")[k] * 180.0 + beam.attenuation("blood")[k] * 20.0;
        before += beam.weights()[k] * std::exp(-water);
        after += beam.weights()[k] * std::exp(-water - beam.iodine()[k] * 20.0 * 20.0);
    }
    const double wanted = still + 255.0 / 1.2 * std::log(after / before);
    EXPECT_NEAR(grey(64, 64), wanted, 2.0);
    EXPECT_LT(wanted, still - 50.0) << "the check is about something that can be seen";
}

TEST(Subtraction, ARoadmapLaysTheVesselBrightUnderTheDevice) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f = patient();
    Image8 out;
    const auto grey = [&](int x, int y) { return static_cast<double>(out.rgb[out.offset(x, y)]); };
    for (int i = 0; i < 3; ++i, ++f.frame_index) renderer.render(f, out);
    f.lumen.contrast_mg_ml.assign(f.lumen.vertices.size(), 20.0);
    for (int i = 0; i < 6; ++i, ++f.frame_index) renderer.render(f, out);
    EXPECT_TRUE(renderer.has_roadmap());

    f.lumen.contrast_mg_ml.clear();
    f.series = {};
    f.series.number = 2;
    for (int i = 0; i < 12; ++i, ++f.frame_index) renderer.render(f, out);
    const double plain = grey(64, 64), beside = grey(20, 64);
    f.series.roadmap = true;
    renderer.render(f, out);
    EXPECT_GT(grey(64, 64), plain + 15.0);
    EXPECT_NEAR(grey(20, 64), beside, 2.0);
    FrameDevice wire;
    wire.points = {Vec3(0, 0, -60), Vec3(0, 0, 60)};
    wire.radius_mm = {0.6};
    wire.materials = {"stainless_steel"};
    wire.material_of = {0};
    f.devices.push_back(wire);
    for (int i = 0; i < 8; ++i, ++f.frame_index) renderer.render(f, out);
    EXPECT_LT(grey(64, 64), grey(58, 64) - 20.0);

    f.view = view(20, 100);  // seen from elsewhere the map would lie
    renderer.render(f, out);
    EXPECT_FALSE(renderer.has_roadmap());
}

TEST(Collimator, WhatItShadesIsBlackAndScattersNoMore) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f = patient();
    f.exposure.scatter_to_primary.reset();
    Image8 out;
    renderer.render(f, out);
    const double open_middle = renderer.intensity().at(64, 20);
    f.view.open_width = 0.5;
    f.view.open_height = 0.75;
    renderer.render(f, out);
    const auto grey = [&](int x, int y) { return static_cast<int>(out.rgb[out.offset(x, y)]); };
    EXPECT_EQ(grey(10, 64), 0);
    EXPECT_EQ(grey(64, 6), 0);
    EXPECT_GT(grey(40, 64), 60);
    EXPECT_GT(grey(64, 24), 60);
    EXPECT_LT(renderer.intensity().at(64, 20), open_middle);  // less of the patient is lit
}

TEST(Reference, IsThePictureAsItStoodWhenItWasKept) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f = patient();
    f.width = 256;
    Image8 out;
    renderer.render(f, out);
    const std::vector<std::uint8_t> then = renderer.fluoroscopy();
    f.series.references = 1;
    f.show_reference = true;
    f.lumen.contrast_mg_ml.assign(f.lumen.vertices.size(), 50.0);
    renderer.render(f, out);
    EXPECT_EQ(renderer.reference(), then);
    EXPECT_NE(renderer.fluoroscopy(), then);
    const FrameRect at = layout_of(f).reference;
    ASSERT_EQ(at.width, 128);
    EXPECT_EQ(out.rgb[out.offset(at.x + 30, at.y + 64)], then[64U * 128U + 30U]);
}

}  // namespace
}  // namespace cathlab
