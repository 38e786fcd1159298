#include "render/frame_renderer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "beam/spectrum.h"
#include "core/errors.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

FrameDescription water_slab(double thickness_mm) {
    FrameDescription f;
    f.width = f.height = 128;
    f.show_inner_view = false;
    f.view = view(0, 100);
    f.exposure.scatter_to_primary = 0;
    FrameSolid slab;
    slab.material = "water";
    slab.surrounding = "air";
    slab.mesh = box({-300, -thickness_mm / 2, -300}, {300, thickness_mm / 2, 300});
    f.solids.push_back(slab);
    return f;
}

FrameDescription patient() {
    FrameDescription f = water_slab(200);
    f.width = 256;
    f.show_inner_view = true;
    const TriMesh tube = cylinder(Vec3::Zero(), 12, 120, 48);
    f.lumen.vertices = tube.vertices;
    f.lumen.triangles = tube.triangles;
    f.lumen.surrounding = "water";
    FrameDevice wire;
    wire.points = {Vec3(0, 0, -60), Vec3(2, 0, 0), Vec3(0, 0, 40)};
    wire.radius_mm = {0.45, 0.45};
    wire.materials = {"stainless_steel"};
    wire.material_of = {0, 0};
    f.devices.push_back(wire);
    FrameCamera camera;  // looks along +z from inside the tube
    camera.pose.position = Vec3(4, 4, -20);
    f.inner_camera = camera;
    return f;
}

TEST(Fluoroscopy, APolychromaticSlabIsTheIntegralOverTheSpectrum) {
    SpectrumSpec spec;
    const FineSpectrum fine = fine_spectrum(spec);
    FrameRenderer renderer(make_gl_target());
    Image8 out;
    for (const double thickness : {50.0, 120.0, 200.0}) {
        FrameDescription f = water_slab(thickness);
        renderer.reset();
        renderer.render(f, out);
        const double truth = signal_transmission(fine, thickness);
        // Near the middle the path is the thickness and the geometry factor one, to 1e-5.
        EXPECT_NEAR(renderer.intensity().at(64, 64) / truth, 1.0, 0.005) << thickness;
    }
}

TEST(Fluoroscopy, NestedMediaAreSumsOfDifferences) {
    FrameRenderer renderer(make_gl_target());
    Image8 out;
    FrameDescription f = water_slab(100);
    renderer.render(f, out);
    const float slab = renderer.intensity().at(64, 64);
    FrameSolid bubble;  // of water in water: must not be seen
    bubble.material = bubble.surrounding = "water";
    bubble.mesh = sphere(Vec3::Zero(), 20, 20);
    f.solids.push_back(bubble);
    f.solids_revision = 1;
    renderer.render(f, out);
    EXPECT_NEAR(renderer.intensity().at(64, 64) / slab, 1.0, 1e-6);
    f.solids.back().material = "air";
    f.solids_revision = 2;
    renderer.render(f, out);
    const double truth = signal_transmission(fine_spectrum({}), 60);
    EXPECT_NEAR(renderer.intensity().at(64, 64) / truth, 1.0, 0.01);
    EXPECT_EQ(renderer.bad_pixels(), 0U);
}

TEST(Fluoroscopy, TheSameDescriptionsGiveTheSameBytesOnAnyThreads) {
    FrameRenderer one(make_gl_target(), Workers(1)), three(make_gl_target(), Workers(3));
    Image8 a, b, again;
    FrameDescription f = patient();
    for (f.frame_index = 0; f.frame_index < 3; ++f.frame_index) {
        one.render(f, a);
        three.render(f, b);
        EXPECT_EQ(a.rgb, b.rgb);
    }
    one.reset();
    for (f.frame_index = 0; f.frame_index < 3; ++f.frame_index) one.render(f, again);
    EXPECT_EQ(a.rgb, again.rgb);
    f.seed = 2;
    one.reset();
    one.render(f, again);
    EXPECT_NE(a.rgb, again.rgb);
}

TEST(Fluoroscopy, TheWireIsDarkOnLightAndTheEmptyVesselAlmostUnseen) {
    FrameRenderer renderer(make_gl_target());
    Image8 out;
    FrameDescription f = patient();
    renderer.render(f, out);
    const ImageF& intensity = renderer.intensity();
    const float beside = intensity.at(20, 64), vessel = intensity.at(74, 64), wire = intensity.at(67, 64);
    EXPECT_NEAR(vessel / beside, 1.0, 0.1);
    EXPECT_LT(wire / vessel, 0.7);
    EXPECT_EQ(renderer.bad_pixels(), 0U);
    f.lumen.contrast_mg_ml.assign(f.lumen.vertices.size(), 100.0);
    renderer.render(f, out);
    EXPECT_LT(renderer.intensity().at(74, 64) / vessel, 0.5);
}

TEST(Fluoroscopy, WithoutTheBeamTheLastImageStays) {
    FrameRenderer renderer(make_gl_target());
    Image8 live, held;
    FrameDescription f = patient();
    f.show_inner_view = false;
    renderer.render(f, live);
    f.beam_on = false;
    f.frame_index = 1;
    f.devices.clear();
    renderer.render(f, held);
    EXPECT_EQ(live.rgb, held.rgb);
}

TEST(Fluoroscopy, AnUnknownMaterialIsNamedBeforeTheFirstFrame) {
    FrameRenderer renderer(make_gl_target());
    Image8 out;
    FrameDescription f = water_slab(100);
    f.solids[0].material = "watre";
    try {
        renderer.render(f, out);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("'water'"), std::string::npos) << error.what();
    }
}

TEST(Fluoroscopy, WhatReachesBehindTheSourceIsToldBeforeThePicture) {
    FrameRenderer renderer(make_gl_target());
    Image8 out;
    FrameDescription f = patient();
    f.view.source = Vec3(0, 60, 0);  // within the slab of 200 mm
    try {
        renderer.render(f, out);
        ADD_FAILURE() << "a source within the patient drew a picture";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("patient's water reaches 41 mm behind the X-ray source"),
                  std::string::npos)
            << error.what();
    }
    f = patient();
    f.devices[0].points[0] = Vec3(0, 900, 0);
    EXPECT_THROW(renderer.render(f, out), UserError);
}

TEST(Target, EglDrawsWhatOsmesaDraws) {
    std::unique_ptr<GlTarget> egl;
    try {
        egl = make_gl_target("egl");
    } catch (const UserError& missing) {
        GTEST_SKIP() << "no surfaceless EGL here: " << missing.what();
    }
    FrameRenderer first(make_gl_target("osmesa")), second(std::move(egl));
    Image8 a, b;
    const FrameDescription f = patient();
    first.render(f, a);
    second.render(f, b);
    std::size_t different = 0;  // another driver may round another way, in few pixels
    for (std::size_t i = 0; i < a.rgb.size(); ++i) different += std::abs(a.rgb[i] - b.rgb[i]) > 2 ? 1 : 0;
    EXPECT_LT(different, a.rgb.size() / 1000);
}

TEST(InnerView, ForceOnTheWallShowsAsColour) {
    FrameRenderer renderer(make_gl_target());
    Image8 calm, pressed;
    FrameDescription f = patient();
    f.devices.clear();
    renderer.render(f, calm);
    f.lumen.wall_force_n.assign(f.lumen.vertices.size(), 0.4);  // half the limit: yellow
    renderer.render(f, pressed);
    const std::size_t at = calm.offset(128 + 20, 20);
    EXPECT_GT(calm.rgb[at], calm.rgb[at + 1] + 30);  // tissue is red
    EXPECT_GT(pressed.rgb[at + 1], calm.rgb[at + 1] + 20);
}

TEST(InnerView, ATipPressedIntoTheWallSeesNoHole) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f;
    f.width = f.height = 128;
    f.show_fluoroscopy = false;
    const TriMesh ball = sphere(Vec3::Zero(), 12.0, 24);
    f.lumen.vertices = ball.vertices;
    f.lumen.triangles = ball.triangles;
    f.lumen.topology_revision = 1;
    for (const double depth : {-0.3, 0.0, 0.5}) {  // of the tip in the wall, mm
        // Looking along the wall, the worst for the near plane.
        FrameCamera camera;
        camera.pose.position = Vec3(12.0 + depth, 0, 0);
        f.inner_camera = camera;
        Image8 out;
        renderer.render(f, out);
        int black = 0;
        for (std::size_t i = 0; i < out.rgb.size(); i += 3) black += out.rgb[i] == 0 ? 1 : 0;
        EXPECT_EQ(black, 0) << depth;
    }
}

TEST(Frame, LayoutsFillTheirPicture) {
    FrameDescription f;
    f.width = 1024;
    f.height = 512;
    FrameLayout both = layout_of(f);
    EXPECT_EQ(both.fluoroscopy.width, 512);
    EXPECT_EQ(both.inner_view.x, 512);
    EXPECT_EQ(both.inner_view.width, 512);
    f.show_inner_view = false;
    EXPECT_EQ(layout_of(f).fluoroscopy.x, 256);
    f.width = 10;
    Image8 out;
    FrameRenderer renderer(make_gl_target());
    EXPECT_THROW(renderer.render(f, out), UserError);
}

TEST(FrameRenderer, AnOpenSurfaceIsToldWithItsPlaceBeforeThePicture) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription f;
    f.width = f.height = 64;
    f.show_inner_view = false;
    const TriMesh ball = sphere(Vec3(0, 0, 0), 20, 10);
    f.lumen.vertices = ball.vertices;
    f.lumen.triangles = {ball.triangles.begin(), ball.triangles.end() - 1};
    Image8 out;
    try {
        renderer.render(f, out);
        ADD_FAILURE() << "an open lumen was drawn";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("not closed: 3 open"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace cathlab
