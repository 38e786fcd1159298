#include "render/labels.h"

#include <gtest/gtest.h>

#include "render/image_intensifier.h"
#include "render/projection.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

FrameDescription ball_with_wire() {
    FrameDescription f;
    f.view = view(30, 200);
    const TriMesh ball = sphere(Vec3(5, -3, 8), 40, 40);
    f.lumen.vertices = ball.vertices;
    f.lumen.triangles = ball.triangles;
    FrameDevice wire;
    wire.name = "wire";
    wire.points = {Vec3(0, 0, -30), Vec3(0, 0, 30)};
    wire.radius_mm = {0.5};
    wire.materials = {"nitinol"};
    wire.material_of = {0};
    f.devices.push_back(wire);
    return f;
}

LabelSource halves(const FrameDescription& f) {
    LabelSource source;
    for (const Vec3& v : f.lumen.vertices) source.region.push_back(v.z() < 8 ? 0 : 1);
    source.region_names = {"low", "high"};
    source.points = {
        {"wire_tip", Vec3(0, 0, 30), true}, {"ostium", Vec3(5, -3, 8), false}, {"far", Vec3(0, 0, 900), true}};
    return source;
}

double area(const std::vector<std::uint8_t>& inside) {
    double sum = 0;
    for (const std::uint8_t v : inside) sum += v;
    return sum;
}

TEST(Labels, MasksAreTheSilhouettes) {
    const FrameDescription f = ball_with_wire();
    const FrameLabels labels = label_frame(f, halves(f), 512, 512, Workers());
    ASSERT_EQ(labels.regions.size(), 2U);
    const Projection projection(f.view, 512, 512);
    std::size_t wrong = 0;
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 512; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * 512 + static_cast<std::size_t>(x);
            const bool in = labels.regions[0].inside[i] != 0 || labels.regions[1].inside[i] != 0;
            const double chord = ball_chord(projection.source(), projection.ray(x + 0.5, y + 0.5), Vec3(5, -3, 8), 40);
            if (in != (chord > 0)) ++wrong;
        }
    }
    // Only along the rim, some 970 pixels long, which the facets cut a little short.
    EXPECT_LT(wrong, 300U);
    // The wire, 60 mm and its half-balls at 1.5 times and 2.56 pixels a mm: its own width and up to a pixel of partial
    // cover.
    const double scale = 1.5 * 2.56;
    EXPECT_GT(area(labels.devices[0].inside), 60 * scale * scale);
    EXPECT_LT(area(labels.devices[0].inside), 61 * scale * (scale + 1));
}

TEST(Labels, TheCameraMatrixPutsAPointWhereTheProjectionDoes) {
    const FrameDescription f = ball_with_wire();
    const FrameLabels labels = label_frame(f, halves(f), 640, 480, Workers());
    const Projection projection(f.view, 640, 480);
    for (const Vec3& p : {Vec3(20, -15, 33), Vec3(-60, 40, -10)}) {
        const auto row = [&](std::size_t k) {
            return labels.camera[4 * k] * p.x() + labels.camera[4 * k + 1] * p.y() + labels.camera[4 * k + 2] * p.z() +
                   labels.camera[4 * k + 3];
        };
        EXPECT_LT((Vec2(row(0), row(1)) / row(2) - projection.pixel(p)).norm(), 1e-9);
    }
    EXPECT_EQ(labels.points[0].visibility, 2);
    EXPECT_EQ(labels.points[1].visibility, 1);
    EXPECT_EQ(labels.points[2].visibility, 0);
    EXPECT_LT((labels.points[0].pixel - projection.pixel(Vec3(0, 0, 30))).norm(), 1e-9);
    EXPECT_LT((labels.lines[0].pixels[0] - projection.pixel(Vec3(0, 0, -30))).norm(), 1e-9);
}

TEST(Labels, WhatIsSeenOfAMaskIsWhatThePictureShows) {
    FrameDescription f = ball_with_wire();
    LabelSource source = halves(f);
    FrameLabels labels = label_frame(f, source, 256, 256, Workers());
    EXPECT_EQ(labels.devices[0].visible, labels.devices[0].inside);
    EXPECT_EQ(area(labels.regions[0].visible), 0);  // blood without medium has no shadow of its own

    for (const Vec3& v : f.lumen.vertices) f.lumen.contrast_mg_ml.push_back(v.z() < 8 ? 100.0 : 0.0);
    FrameDevice sleeve;  // along the wire's lower half, of a plastic that is thinner to X-rays than the wire
    sleeve.name = "sleeve";
    sleeve.points = {Vec3(0, 0, -30), Vec3(0, 0, 0)};
    sleeve.radius_mm = {2.0};
    sleeve.inner_radius_mm = {1.5};
    sleeve.materials = {"ptfe"};
    sleeve.material_of = {0};
    f.devices.push_back(sleeve);
    labels = label_frame(f, source, 256, 256, Workers());
    EXPECT_GT(area(labels.regions[0].visible), 0.5 * area(labels.regions[0].inside));
    EXPECT_LT(area(labels.regions[1].visible), 0.1 * area(labels.regions[1].inside));  // where they meet
    // The wire is seen through the sleeve and takes its pixels from it.
    EXPECT_GT(area(labels.devices[0].visible), 0.98 * area(labels.devices[0].inside));
    EXPECT_LT(area(labels.devices[1].visible), 0.9 * area(labels.devices[1].inside));
    for (std::size_t i = 0; i < labels.devices[0].inside.size(); ++i) {
        EXPECT_LE(labels.devices[0].visible[i] + labels.devices[1].visible[i], 1);
        EXPECT_LE(labels.devices[1].visible[i], labels.devices[1].inside[i]);
        EXPECT_LE(labels.regions[0].visible[i] + labels.devices[1].inside[i], 1);
    }

    f.view.open_height = 0.3;  // blades hide the wire's ends, and a key point there
    labels = label_frame(f, source, 256, 256, Workers());
    EXPECT_LT(area(labels.devices[0].visible), 0.7 * area(labels.devices[0].inside));
    EXPECT_EQ(labels.points[0].visibility, 1);
}

TEST(Labels, FollowAnImageIntensifiersBend) {
    FrameDescription f = ball_with_wire();
    f.exposure.detector = detector_preset("image_intensifier");
    const FrameLabels labels = label_frame(f, halves(f), 512, 512, Workers());
    const Pincushion bent(f.exposure.detector.pincushion, 512, 512);
    const Projection projection(f.view, 512, 512);
    EXPECT_LT((labels.points[0].pixel - bent.shown(projection.pixel(Vec3(0, 0, 30)))).norm(), 1e-9);
    // The wire's end lies in its mask.
    const Vec2 end = bent.shown(projection.pixel(Vec3(0, 0, 28)));
    EXPECT_EQ(labels.devices[0].inside[static_cast<std::size_t>(end.y()) * 512 + static_cast<std::size_t>(end.x())], 1);
    EXPECT_EQ(labels.regions[0].inside[3], 0);
}

}  // namespace
}  // namespace cathlab
