#include "render/device_chords.h"

#include <gtest/gtest.h>

#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

FrameDevice chain(const std::vector<Vec3>& points, double radius, double bore = 0) {
    FrameDevice device;
    device.points = points;
    const std::size_t n = points.size() - 1;
    device.radius_mm.assign(n, radius);
    if (bore > 0) device.inner_radius_mm.assign(n, bore);
    device.materials = {"nitinol"};
    device.material_of.assign(n, 0);
    return device;
}

std::vector<ChordPiece> pieces_of(const FrameDevice& device) {
    std::vector<ChordPiece> pieces;
    append_pieces(device, {0}, pieces);
    return pieces;
}

double total(const std::vector<ChordPiece>& pieces, const Vec3& origin, const Vec3& direction) {
    double sum = 0;
    for (const ChordPiece& p : pieces) sum += chord(p, origin, direction);
    return sum;
}

TEST(WireChord, AtAnyAngleIsTheDiameterOverTheSine) {
    for (const double angle : {15.0, 45.0, 75.0, 90.0}) {
        const double a = angle * units::deg;
        const auto pieces = pieces_of(chain({Vec3(-100, 0, 0), Vec3(100, 0, 0)}, 0.45));
        const Vec3 direction(std::cos(a), std::sin(a), 0);
        EXPECT_NEAR(total(pieces, -50 * direction, direction), 0.9 / std::sin(a), 1e-10);
        // Off the axis by h: the chord of the circle.
        EXPECT_NEAR(total(pieces, Vec3(0, 0, 0.3) - 50 * direction, direction),
                    2 * std::sqrt(0.45 * 0.45 - 0.09) / std::sin(a), 1e-10);
    }
}

TEST(WireChord, AStraightChainHasNoBeadsAtItsJoints) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 40; ++i) points.emplace_back(Vec3(-40 + 2.0 * i, 0, 0));
    const auto pieces = pieces_of(chain(points, 0.45));
    for (double x = -30; x < 30; x += 0.037) {
        EXPECT_NEAR(total(pieces, Vec3(x, 0, 0.1), Vec3(0.6, 0.8, 0)), 2 * std::sqrt(0.45 * 0.45 - 0.01) / 0.8, 1e-9);
    }
}

TEST(WireChord, ABentChainIsNeitherThickerNorThinnerAtItsJoints) {
    std::vector<Vec3> points;  // an arc of 20 mm radius seen along its normal: the middle line's chord is the diameter
    for (int i = 0; i <= 30; ++i) {
        const double a = 0.1 * i;
        points.emplace_back(20 * std::cos(a), 0, 20 * std::sin(a));
    }
    const auto pieces = pieces_of(chain(points, 0.45));
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3 beside(1e-5, 0, 1e-5);  // off the joint's plane itself, which belongs to both pieces
        EXPECT_NEAR(total(pieces, points[i] + beside - Vec3(0, 50, 0), Vec3::UnitY()), 0.9, 1e-9);
        const Vec3 middle = 0.5 * (points[i] + points[i + 1]);
        EXPECT_NEAR(total(pieces, middle - Vec3(0, 50, 0), Vec3::UnitY()), 0.9, 1e-9);
    }
}

TEST(WireChord, ATubeIsOuterMinusInner) {
    const auto pieces = pieces_of(chain({Vec3(-100, 0, 0), Vec3(0, 0, 0), Vec3(100, 0, 0)}, 1.35, 0.6));
    EXPECT_NEAR(total(pieces, Vec3(0.3, -50, 0), Vec3::UnitY()), 1.5, 1e-10);
    EXPECT_NEAR(total(pieces, Vec3(0.3, -50, 1.0), Vec3::UnitY()), 2 * std::sqrt(1.35 * 1.35 - 1), 1e-10);
}

TEST(WireChord, AFreeEndIsAHalfBall) {
    const auto pieces = pieces_of(chain({Vec3(-10, 0, 0), Vec3(0, 0, 0)}, 0.5));
    EXPECT_NEAR(total(pieces, Vec3(0.3, -50, 0), Vec3::UnitY()), 2 * std::sqrt(0.25 - 0.09), 1e-10);
    EXPECT_NEAR(total(pieces, Vec3(-50, 0, 0), Vec3::UnitX()), 11.0, 1e-9);
}

TEST(WireChord, TheDrawnVolumeIsThatOfTheWireAndTheThreadsDoNotMatter) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 60; ++i) points.emplace_back(-45 + 1.5 * i, 3 * std::sin(0.2 * i), 10 * std::cos(0.1 * i));
    double length = 0;
    for (int i = 0; i < 60; ++i) {
        length += (points[static_cast<std::size_t>(i) + 1] - points[static_cast<std::size_t>(i)]).norm();
    }
    const Projection projection(view(20, 200), 512, 512);
    for (const double radius : {0.45, 2.5}) {
        const auto pieces = pieces_of(chain(points, radius));
        DeviceLengths one, three;
        draw_devices(pieces, 1, projection, 3, Workers(1), one);
        draw_devices(pieces, 1, projection, 3, Workers(3), three);
        EXPECT_EQ(one.pixel, three.pixel);
        EXPECT_EQ(one.length_mm, three.length_mm);
        double volume = 0;  // each ray stands for a pixel's area shrunk to the depth of the wire, along the normal
        for (std::size_t i = 0; i < one.pixel.size(); ++i) {
            const Vec3 ray = projection.ray(one.pixel[i] % 512 + 0.5, static_cast<double>(one.pixel[i] / 512) + 0.5);
            volume += one.length_mm[i] * ray.dot(projection.normal());
        }
        volume *= std::pow(projection.pixel_mm() * 800 / 1200, 2);
        const double truth = units::pi * radius * radius * length + 4.0 / 3 * units::pi * std::pow(radius, 3);
        EXPECT_NEAR(volume / truth, 1.0, 0.02);
    }
}

}  // namespace
}  // namespace cathlab
