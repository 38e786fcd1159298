#include "render/path_lengths.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "render/gl_device.h"
#include "render/gl_target.h"
#include "render/path_raster.h"
#include "render/path_surface.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

// Both ways to the same lengths: GL for the torso's solids, our own scan conversion for the lumen.
enum class By { gl, raster };

PathLengths by_gl(const CArmView& view, const std::vector<TriMesh>& meshes, int size) {
    static const auto device = std::make_shared<GlDevice>(make_osmesa_target());
    static PathLengthBuffer buffer(device);
    std::vector<std::unique_ptr<PathSurface>> kept;
    std::vector<const PathSurface*> surfaces;
    for (const TriMesh& mesh : meshes) {
        kept.push_back(buffer.make_surface());
        buffer.set_triangles(*kept.back(), mesh.triangles);
        buffer.set_vertices(*kept.back(), mesh.vertices);
        surfaces.push_back(kept.back().get());
    }
    PathLengths out;
    buffer.draw(Projection(view, size, size), surfaces, out);
    return out;
}

PathLengths by_raster(const CArmView& view, const std::vector<TriMesh>& meshes, int size,
                      const std::vector<double>& values = {}, const std::vector<double>& widths = {}) {
    TriMesh all;
    for (const TriMesh& mesh : meshes) {
        const Triangle shift = Triangle::Constant(static_cast<Index>(all.vertices.size()));
        all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        for (const Triangle& t : mesh.triangles) all.triangles.emplace_back(t + shift);
    }
    PathRaster raster;
    PathLengths out;
    raster.draw(Projection(view, size, size), all.vertices, all.triangles, values, out, widths);
    return out;
}

class PathLength : public testing::TestWithParam<By> {
protected:
    static PathLengths draw(const CArmView& view, const std::vector<TriMesh>& meshes, int size = 256) {
        return GetParam() == By::gl ? by_gl(view, meshes, size) : by_raster(view, meshes, size);
    }
};
INSTANTIATE_TEST_SUITE_P(By, PathLength, testing::Values(By::gl, By::raster),
                         [](const auto& way) { return way.param == By::gl ? "gl" : "raster"; });

// Mean and largest |error| of drawn path lengths against a closed form, relative to `scale`, where the truth is above
// `least`.
template <class Truth>
std::pair<double, double> errors(const PathLengths& drawn, const Projection& projection, double least, double scale,
                                 const Truth& truth) {
    double sum = 0, largest = 0;
    int count = 0;
    for (int y = 0; y < projection.height(); ++y) {
        for (int x = 0; x < projection.width(); ++x) {
            const double t = truth(projection.source(), projection.ray(x + 0.5, y + 0.5));
            if (t < least) continue;
            const double error = std::fabs(drawn.length_mm.at(x, y) - t) / scale;
            sum += error;
            largest = std::max(largest, error);
            ++count;
        }
    }
    return {count > 0 ? sum / count : 1e9, largest};
}

TEST_P(PathLength, ASlabSeenAtAnyAngleIsItsThicknessOverTheCosine) {
    for (const double angle : {-50.0, 0.0, 25.0, 60.0}) {
        const CArmView v = view(angle, 60);
        const PathLengths drawn = draw(v, {box({-300, -20, -300}, {300, 30, 300})});
        const auto [mean, largest] = errors(drawn, Projection(v, 256, 256), 1, 50,
                                            [](const Vec3&, const Vec3& d) { return 50.0 / std::fabs(d.y()); });
        EXPECT_LT(mean, 1e-4) << angle;
        EXPECT_LT(largest, 1e-4) << angle;
        EXPECT_EQ(drawn.bad_pixels, 0U);
    }
}

TEST_P(PathLength, ASphereIsItsChordAndTheErrorIsSecondOrder) {
    const CArmView v = view(30, 160);
    const Vec3 center(5, -3, 8);
    const auto truth = [&](const Vec3& o, const Vec3& d) { return ball_chord(o, d, center, 40); };
    const Projection projection(v, 256, 256);
    std::vector<double> error;  // of 1,200, 4,900, 19,600 and 78,400 triangles
    for (const int rings : {17, 35, 70, 140})
        error.push_back(errors(draw(v, {sphere(center, 40, rings)}), projection, 0.1, 80, truth).first);
    EXPECT_LT(error[2], 1e-3);
    EXPECT_NEAR(error[1] / error[2], 4.0, 0.6);
    EXPECT_NEAR(error[0] / error[2], 16.0 * std::pow(35.0 / 34.0, 2), 2.0);  // two halvings of the edges
    EXPECT_NEAR(error[1] / error[3], 16.0, 3.0);
}

TEST_P(PathLength, ATorusIsItsChordEvenWhereARayPassesItTwice) {
    const CArmView v = view(25, 160);
    const Vec3 center(4, -6, 3);
    const Projection projection(v, 256, 256);
    const PathLengths drawn = draw(v, {torus(center, 35, 12, 320, 140)});
    const auto truth = [&](const Vec3& o, const Vec3& d) { return torus_chord(o, d, center, 35, 12); };
    EXPECT_LT(errors(drawn, projection, 0.1, 24, truth).first, 1e-3);
    EXPECT_EQ(drawn.bad_pixels, 0U);
}

TEST_P(PathLength, ACylinderIsItsChord) {
    const CArmView v = view(-20, 80);
    const PathLengths drawn = draw(v, {cylinder(Vec3::Zero(), 15, 400, 160)});
    const auto truth = [](const Vec3& o, const Vec3& d) {
        const Vec3 flat(d.x(), d.y(), 0), from(o.x(), o.y(), 0);
        const double across = std::fabs(from.x() * flat.y() - from.y() * flat.x()) / flat.norm();
        return across < 15 ? 2 * std::sqrt(225 - across * across) / flat.norm() : 0.0;
    };
    EXPECT_LT(errors(drawn, Projection(v, 256, 256), 0.1, 30, truth).first, 1e-3);
}

TEST_P(PathLength, TwoSurfacesAddAndNestedOnesAreCountedTwice) {
    const CArmView v = view(0, 160);
    const PathLengths drawn = draw(v, {sphere(Vec3::Zero(), 40, 70), sphere(Vec3(6, 2, 4), 15, 50)});
    const auto truth = [](const Vec3& o, const Vec3& d) {
        return ball_chord(o, d, Vec3::Zero(), 40) + ball_chord(o, d, Vec3(6, 2, 4), 15);
    };
    EXPECT_LT(errors(drawn, Projection(v, 256, 256), 0.1, 80, truth).first, 1e-3);
    EXPECT_EQ(drawn.bad_pixels, 0U);
}

TEST_P(PathLength, AHoleIsCountedAndDrawsNothing) {
    TriMesh open = sphere(Vec3::Zero(), 30, 20);
    open.triangles.erase(open.triangles.begin() + 800, open.triangles.begin() + 806);
    const PathLengths drawn = draw(view(0, 120), {open});
    EXPECT_GT(drawn.bad_pixels, 3U);
    for (const float length : drawn.length_mm.values) EXPECT_LT(std::fabs(length), 61.0F);
}

TEST(PathRaster, ContrastMediumIsItsConcentrationTimesThePath) {
    const CArmView v = view(10, 120);
    const TriMesh ball = sphere(Vec3::Zero(), 30, 40);
    const PathLengths even = by_raster(v, {ball}, 128, std::vector<double>(ball.vertices.size(), 50.0));
    std::vector<double> ramp;  // along the axis of view: the integral needs the trapezoid
    const Vec3 axis = (v.detector_center - v.source).normalized();
    for (const Vec3& p : ball.vertices) ramp.push_back(40 + p.dot(axis));
    const PathLengths sloped = by_raster(v, {ball}, 128, ramp);
    const Projection projection(v, 128, 128);
    for (const int y : {40, 64, 90}) {
        for (const int x : {50, 64, 70}) {
            const double length = even.length_mm.at(x, y);
            EXPECT_NEAR(even.contrast_mm_mg_ml.at(x, y), 50 * length, 0.01 * length);
            const Vec3 d = projection.ray(x + 0.5, y + 0.5);
            const Vec3 middle = projection.source() - projection.source().dot(d) * d;  // of the chord
            EXPECT_NEAR(sloped.contrast_mm_mg_ml.at(x, y), (40 + middle.dot(axis)) * length, 0.5 * length);
        }
    }
}

TEST(PathRaster, OfTwoVesselsBehindOneAnotherEachHasItsOwnMedium) {
    const CArmView v = view(0, 160);
    const Vec3 axis = (v.detector_center - v.source).normalized();
    const TriMesh front = sphere(-50 * axis, 20, 40), back = sphere(50 * axis, 20, 40);
    std::vector<double> values;  // a steep front in one, nothing in the other
    for (const Vec3& p : front.vertices) values.push_back(100 + 4 * (p + 50 * axis).dot(axis));
    const PathLengths alone = by_raster(v, {front}, 128, values);
    values.insert(values.end(), back.vertices.size(), 0.0);
    const PathLengths both = by_raster(v, {front, back}, 128, values);
    double most = 0;
    for (std::size_t i = 0; i < alone.contrast_mm_mg_ml.values.size(); ++i) {
        EXPECT_NEAR(both.contrast_mm_mg_ml.values[i], alone.contrast_mm_mg_ml.values[i], 0.05) << i;
        most = std::max<double>(most, alone.contrast_mm_mg_ml.values[i]);
    }
    EXPECT_NEAR(most, 40 * 100, 40);  // through the middle
}

TEST(PathRaster, OfTwoVesselsInOneEachEndCountsByItsWidth) {
    // A ball whose near half is the end of a branch and whose far half the wall of a wide vessel.
    const CArmView v = view(0, 120);
    const Vec3 axis = (v.detector_center - v.source).normalized();
    const TriMesh ball = sphere(Vec3::Zero(), 30, 60);
    std::vector<double> values, widths, even;
    for (const Vec3& p : ball.vertices) {
        const bool branch = p.dot(axis) < 0.0;
        values.push_back(branch ? 320.0 : 70.0);
        widths.push_back(branch ? 2.0 : 15.0);
        even.push_back(15.0);
    }
    const PathLengths drawn = by_raster(v, {ball}, 128, values, widths);
    const PathLengths trapezoid = by_raster(v, {ball}, 128, values, even);
    const PathLengths plain = by_raster(v, {ball}, 128, values);
    const double length = drawn.length_mm.at(64, 64);
    EXPECT_NEAR(drawn.contrast_mm_mg_ml.at(64, 64), length * (2.0 * 320.0 + 15.0 * 70.0) / 17.0, 0.01 * length);
    EXPECT_NEAR(trapezoid.contrast_mm_mg_ml.at(64, 64), length * 195.0, 0.01 * length);
    for (std::size_t i = 0; i < plain.contrast_mm_mg_ml.values.size(); ++i) {
        const float p = plain.contrast_mm_mg_ml.values[i];
        EXPECT_NEAR(trapezoid.contrast_mm_mg_ml.values[i], p, 1e-4F * (1.0F + p));
    }
}

TEST(PathRaster, ASurfaceFinerThanThePixelsIsClosedAndKeepsItsVolume) {
    const CArmView v = view(-25, 100);
    const TriMesh ball = sphere(Vec3(3, -4, 2), 20, 160);  // 102,000 triangles on some 20,000 pixels
    const PathLengths drawn = by_raster(v, {ball}, 256);
    EXPECT_EQ(drawn.bad_pixels, 0U);
    const Projection projection(v, 256, 256);
    const auto truth = [](const Vec3& o, const Vec3& d) { return ball_chord(o, d, Vec3(3, -4, 2), 20); };
    const auto [mean, largest] = errors(drawn, projection, 0.5, 40, truth);
    EXPECT_LT(mean, 1e-3);
    EXPECT_LT(largest, 2e-2);  // at the rim, where the chord rises steeply
}

TEST(PathRaster, EveryBitIsTheSameOnAnyThreads) {
    const TriMesh mesh = torus(Vec3(0, 0, 0), 60, 25, 96, 48);
    std::vector<double> values;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) values.push_back(static_cast<double>(i % 17));
    const CArmView v = view(35, 300);
    for (const bool with_values : {false, true}) {
        PathLengths alone, several;
        const std::vector<double> none;
        PathRaster().draw(Projection(v, 301, 301), mesh.vertices, mesh.triangles, with_values ? values : none, alone);
        PathRaster raster(Workers(3));
        for (int again = 0; again < 2; ++again) {  // what is kept from picture to picture leaves no trace
            raster.draw(Projection(v, 301, 301), mesh.vertices, mesh.triangles, with_values ? values : none, several);
            EXPECT_TRUE(alone.length_mm.values == several.length_mm.values);
            EXPECT_TRUE(alone.contrast_mm_mg_ml.values == several.contrast_mm_mg_ml.values);
            EXPECT_EQ(several.bad_pixels, 0U);
        }
        EXPECT_GT(*std::max_element(alone.length_mm.values.begin(), alone.length_mm.values.end()), 25.0F);
    }
}

TEST(PathRaster, WhatLiesPartlyBesideThePictureIsDrawnAsFarAsItIsSeen) {
    const CArmView v = view(0, 60);
    const TriMesh tube = cylinder(Vec3(12, 0, 0), 8, 400, 64);
    const PathLengths whole = by_raster(v, {tube}, 128), gl = by_gl(v, {tube}, 128);
    EXPECT_EQ(whole.bad_pixels, 0U);
    for (std::size_t i = 0; i < whole.length_mm.values.size(); ++i)
        EXPECT_NEAR(whole.length_mm.values[i], gl.length_mm.values[i], 0.02) << i;
}

TEST(Projection, AFiducialFallsWhereThePinholeSays) {
    const CArmView v = view(35, 200);
    const Projection projection(v, 512, 512);
    const Vec3 p(20, -15, 33);
    const double a = 35 * units::deg;
    // In the C-arm's frame: s across, t down, depth from the source.
    const double s = std::cos(a) * p.x() + std::sin(a) * p.y();
    const double depth = 800 + std::sin(a) * p.x() - std::cos(a) * p.y();
    const Vec2 truth((s * 1200 / depth / 200 + 0.5) * 512, (-p.z() * 1200 / depth / 200 + 0.5) * 512);
    EXPECT_LT((projection.pixel(p) - truth).norm(), 1e-9);
    const Vec3 back = projection.ray(truth.x(), truth.y());
    EXPECT_LT((p - v.source).cross(back).norm(), 1e-9);
}

TEST_P(PathLength, AFiducialsShadowLiesWithinATenthOfAPixel) {
    const CArmView v = view(35, 200);
    const Projection projection(v, 512, 512);
    const Vec3 p(20, -15, 33);
    const PathLengths drawn = draw(v, {sphere(p, 4, 40)}, 512);
    Vec2 sum = Vec2::Zero();
    double weight = 0;
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 512; ++x) {
            sum += drawn.length_mm.at(x, y) * Vec2(x + 0.5, y + 0.5);
            weight += drawn.length_mm.at(x, y);
        }
    }
    EXPECT_LT((sum / weight - projection.pixel(p)).norm(), 0.1);
}

TEST(Projection, ImpossibleGeometryIsRefused) {
    CArmView v = view(0, 200);
    v.width_mm = 0;
    EXPECT_THROW(Projection(v, 512, 512), UserError);
    v = view(0, 200);
    v.detector_center = v.source;
    EXPECT_THROW(Projection(v, 512, 512), UserError);
    v = view(0, 200);
    v.right *= 1.5;
    EXPECT_THROW(Projection(v, 512, 512), UserError);
}

TEST(Target, AnUnknownNameIsTheUsersMistake) {
    EXPECT_THROW(make_gl_target("osmessa"), UserError);
}

}  // namespace
}  // namespace cathlab
