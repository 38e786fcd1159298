// The whole chain, from the C-arm to what the detector read, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "beam/c_arm.h"
#include "core/errors.h"
#include "render/attenuation.h"
#include "render/detector.h"
#include "render/frame_renderer.h"
#include "render/image_intensifier.h"
#include "render/projection.h"
#include "render/scatter.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

FrameDescription empty_room(double field_mm = 100) {
    FrameDescription f;
    f.width = f.height = 128;
    f.show_inner_view = false;
    f.view = view(0, field_mm);
    f.exposure.scatter_to_primary = 0;
    return f;
}

FrameSolid solid(const char* material, const char* surrounding, TriMesh mesh) {
    FrameSolid out;
    out.material = material;
    out.surrounding = surrounding;
    out.mesh = std::move(mesh);
    return out;
}

FrameRenderer& renderer() {
    static FrameRenderer shared(make_gl_target());
    shared.reset();
    return shared;
}

// sum over the bins of weight exp(-sum of mu length), the geometry's cos^3 left out.
struct Media {
    const char* inside;
    const char* outside;
    double length_mm;
};
double beer_lambert(const BeamTable& beam, const std::vector<Media>& media) {
    double sum = 0;
    for (std::size_t k = 0; k < energy_bins; ++k) {
        double exponent = 0;
        for (const Media& m : media)
            exponent += (beam.attenuation(m.inside)[k] - beam.attenuation(m.outside)[k]) * m.length_mm;
        sum += beam.weights()[k] * std::exp(-exponent);
    }
    return sum;
}

double cosine_cubed(const Projection& projection, double x, double y) {
    return std::pow(projection.ray(x, y).dot(projection.normal()), 3);
}

TEST(Chain, NestedSpheresAreTheSumOfTheirDifferences) {
    FrameDescription f = empty_room(220);
    f.width = f.height = 256;
    const Vec3 inner(6, 2, 4);
    f.solids.push_back(solid("water", "air", sphere(Vec3::Zero(), 70, 100)));
    f.solids.push_back(solid("cortical_bone", "water", sphere(inner, 25, 100)));
    f.solids.push_back(solid("air", "cortical_bone", sphere(inner, 12, 100)));
    FrameRenderer& r = renderer();
    Image8 out;
    r.render(f, out);
    const BeamTable beam(f.exposure.kvp, f.exposure.copper_mm);
    const Projection projection(f.view, 256, 256);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const Vec3 ray = projection.ray(x + 0.5, y + 0.5);
            const auto through = [&](const Vec3& center, double radius) {
                return ball_chord(projection.source(), ray, center, radius);
            };
            if (through(Vec3::Zero(), 70) < 1) continue;
            const double truth = cosine_cubed(projection, x + 0.5, y + 0.5) *
                                 beer_lambert(beam, {{"water", "air", through(Vec3::Zero(), 70)},
                                                     {"cortical_bone", "water", through(inner, 25)},
                                                     {"air", "cortical_bone", through(inner, 12)}});
            sum += std::fabs(r.intensity().at(x, y) / truth - 1);
            ++count;
        }
    }
    EXPECT_LT(sum / count, 1e-3);
    EXPECT_EQ(r.bad_pixels(), 0U);
}

TEST(Chain, AWireInALumenInABodyIsTheSumOfItsDifferences) {
    FrameDescription f = empty_room(60);
    f.width = f.height = 256;
    f.solids.push_back(solid("soft_tissue", "air", box({-300, -100, -300}, {300, 100, 300})));
    const TriMesh tube = cylinder(Vec3::Zero(), 10, 400, 360);
    f.lumen.vertices = tube.vertices;
    f.lumen.triangles = tube.triangles;
    FrameDevice wire;
    wire.points = {Vec3(3, 0, -150), Vec3(3, 0, 150)};
    wire.radius_mm = {1.2};
    wire.materials = {"nitinol"};
    wire.material_of = {0};
    f.devices.push_back(wire);
    FrameRenderer& r = renderer();
    Image8 out;
    r.render(f, out);
    const BeamTable beam(f.exposure.kvp, f.exposure.copper_mm);
    const Projection projection(f.view, 256, 256);
    const auto round = [&](const Vec3& d, double x0, double radius) {
        const double flat = std::hypot(d.x(), d.y());
        const double across =
            std::fabs((projection.source().x() - x0) * d.y() - projection.source().y() * d.x()) / flat;
        return across < radius ? 2 * std::sqrt(radius * radius - across * across) / flat : 0.0;
    };
    double sum = 0, largest = 0;
    int count = 0;
    for (int y = 0; y < 256; y += 5) {
        for (int x = 0; x < 256; ++x) {
            double length = 0;  // the mean over the pixel's 2 x 2 rays, which the renderer takes of so thick a device
            for (int i = 0; i < 4; ++i)
                length += round(projection.ray(x + 0.25 + 0.5 * (i % 2), y + 0.25 + 0.5 * (i / 2)), 3, 1.2) / 4;
            const Vec3 ray = projection.ray(x + 0.5, y + 0.5);
            const double truth = cosine_cubed(projection, x + 0.5, y + 0.5) *
                                 beer_lambert(beam, {{"soft_tissue", "air", 200 / std::fabs(ray.y())},
                                                     {"blood", "soft_tissue", round(ray, 0, 10)},
                                                     {"nitinol", "blood", length}});
            const double error = std::fabs(r.intensity().at(x, y) / truth - 1);
            sum += error;
            largest = std::max(largest, error);
            ++count;
        }
    }
    EXPECT_LT(sum / count, 1e-3);
    EXPECT_LT(largest, 5e-3);  // at the lumen's rim
}

TEST(Chain, WithoutAPatientTheFieldFallsWithTheCubeOfTheCosine) {
    FrameDescription f = empty_room(400);
    FrameRenderer& r = renderer();
    Image8 out;
    r.render(f, out);
    const Projection projection(f.view, 128, 128);
    for (const auto& [x, y] : {std::pair(64, 64), std::pair(0, 64), std::pair(127, 0), std::pair(20, 100)})
        EXPECT_NEAR(r.intensity().at(x, y) / cosine_cubed(projection, x + 0.5, y + 0.5), 1.0, 1e-5);
    // Inverse square: the corner is farther from the focus, and sees its pixel obliquely.
    const double corner = 1200.0 / std::sqrt(1200.0 * 1200.0 + 2 * 198.4375 * 198.4375);
    EXPECT_NEAR(r.intensity().at(127, 0) / r.intensity().at(64, 64), std::pow(corner, 3), 1e-4);
}

TEST(Chain, AMarkersShadowLiesWhereTheCArmsProjectionSaysAtAnyAngle) {
    CArmSpec spec;
    spec.columns = spec.rows = 512;
    for (const auto& [primary, secondary] :
         {std::pair(0, 0), std::pair(40, 25), std::pair(-30, -35), std::pair(90, 0)}) {
        const Vec3 isocentre(10, 20, -310);
        const CArmPose pose = c_arm_pose(spec, isocentre, primary, secondary);
        FrameDescription f = empty_room();
        f.width = f.height = 512;
        f.view = {pose.source, pose.detector, pose.right, pose.down, spec.field_mm, spec.field_mm};
        for (const Vec3& offset : {Vec3(21, -17, 33), Vec3(-30, 12, -24)}) {
            const Vec3 marker = isocentre + offset;
            f.solids = {solid("aluminium", "air", sphere(marker, 2, 30))};
            ++f.solids_revision;
            FrameRenderer& r = renderer();
            Image8 out;
            r.render(f, out);
            const Projection projection(f.view, 512, 512);
            Vec2 sum = Vec2::Zero();
            double weight = 0;
            for (int y = 0; y < 512; ++y) {
                for (int x = 0; x < 512; ++x) {
                    const double dark = -std::log(r.intensity().at(x, y) / cosine_cubed(projection, x + 0.5, y + 0.5));
                    if (dark < 1e-4) continue;
                    sum += dark * Vec2(x, y);
                    weight += dark;
                }
            }
            ASSERT_GT(weight, 1.0);
            EXPECT_LT((sum / weight - project(spec, pose, marker)).norm(), 0.1) << primary << " " << secondary;
        }
    }
}

TEST(Chain, TheNoiseIsThatOfTheKermaAndFallsWithItsRoot) {
    const BeamTable beam(80, 0.3);
    std::vector<double> relative;
    for (const double kerma : {20.0, 40.0, 80.0, 320.0}) {
        FrameDescription f = empty_room(51.2);  // pixels of 0.4 mm
        f.solids.push_back(solid("water", "air", box({-300, -100, -300}, {300, 100, 300})));
        f.exposure.detector_kerma_ngy = kerma;
        f.exposure.detector.blur_sigma_mm = 0;
        f.exposure.focal_spot_mm = 0;
        f.exposure.detector.electronic_noise_photons = 0;
        FrameRenderer& r = renderer();
        Image8 out;
        double sum = 0, squares = 0, n = 0;
        for (f.frame_index = 0; f.frame_index < 4; ++f.frame_index) {
            r.render(f, out);
            for (const float v : r.detected().values) {
                sum += v;
                squares += static_cast<double>(v) * v;
                n += 1;
            }
        }
        const double mean = sum / n, variance = squares / n - mean * mean;
        EXPECT_NEAR(variance / mean, 1.0, 0.02) << kerma;                                      // slope
        EXPECT_NEAR(mean / (kerma * 0.16 * beam.photons_per_mm2_ngy()), 1.0, 0.005) << kerma;  // gain
        relative.push_back(std::sqrt(variance) / mean);
    }
    EXPECT_NEAR(relative[0] / relative[2], 2.0, 0.04);
    EXPECT_NEAR(relative[0] / relative[3], 4.0, 0.08);
}

TEST(Chain, TheReadOutsNoiseAddsItsVariance) {
    FrameDescription f = empty_room(51.2);
    f.exposure.detector.blur_sigma_mm = 0;
    f.exposure.focal_spot_mm = 0;
    f.exposure.detector.electronic_noise_photons = 9;
    f.width = f.height = 256;
    FrameRenderer& r = renderer();
    Image8 out;
    r.render(f, out);
    double sum = 0, squares = 0;
    const double n = static_cast<double>(r.detected().values.size());
    for (const float v : r.detected().values) {
        sum += v;
        squares += static_cast<double>(v) * v;
    }
    const double mean = sum / n;
    EXPECT_NEAR((squares / n - mean * mean) / (mean + 81), 1.0, 0.02);
}

TEST(Chain, ScatterFillsTheShadowsAndGrowsWithThePatient) {
    const auto lead_shadow = [](double water_mm) {
        FrameDescription f = empty_room(300);
        f.exposure.scatter_to_primary.reset();
        f.solids.push_back(solid("water", "air", box({-300, -water_mm / 2, -300}, {300, water_mm / 2, 300})));
        f.solids.push_back(solid("tungsten", "water", box({-3, -10, -3}, {3, 10, 3})));
        FrameRenderer& r = renderer();
        Image8 out;
        r.render(f, out);
        return r.intensity().at(64, 64) / (r.intensity().at(90, 64) - r.intensity().at(64, 64));  // scatter / primary
    };
    // The beam is 200 mm wide at the isocentre (SID 1200, M taken as 1.45: 207 mm).
    EXPECT_NEAR(lead_shadow(200) / scatter_to_primary(200, 300 / 1.45), 1.0, 0.05);
    EXPECT_NEAR(lead_shadow(100) / lead_shadow(200), 0.5, 0.03);
    EXPECT_NEAR(scatter_to_primary(200, 300), 0.366, 0.001);
}

TEST(Chain, TheFocalSpotBlursByItsMagnification) {
    // The edge of a thin plate at the isocentre: its shadow widens by (M - 1) times the spot.
    const auto spread = [](double spot_mm, double isocentre_mm) {
        FrameDescription f = empty_room(25.6);
        f.width = f.height = 256;
        f.exposure.focal_spot_mm = spot_mm;
        f.exposure.detector.blur_sigma_mm = 0;
        f.exposure.detector.electronic_noise_photons = 0;
        f.exposure.detector_kerma_ngy = 1e9;
        f.view.source_isocentre_mm = isocentre_mm;
        f.solids.push_back(solid("copper", "air", box({-100, -0.5, -100}, {0, 0.5, 100})));
        FrameRenderer& r = renderer();
        Image8 out;
        r.render(f, out);
        double sum = 0, first = 0, second = 0;  // moments of the edge's derivative
        for (int x = 96; x < 160; ++x) {
            double line = 0;
            for (int y = 100; y < 156; ++y) line += r.detected().at(x + 1, y) - r.detected().at(x, y);
            sum += line;
            first += line * x;
            second += line * x * x;
        }
        return std::sqrt(std::max(0.0, second / sum - first * first / (sum * sum))) * 0.1;  // mm
    };
    const double sharp = spread(0.0, 800);
    const double blurred = std::sqrt(std::pow(spread(1.0, 800), 2) - sharp * sharp);
    EXPECT_NEAR(blurred, 0.5 / std::sqrt(12.0), 0.01);  // a box of (M - 1) * 1 mm, M = 1200 / 800
    EXPECT_NEAR(std::sqrt(std::pow(spread(1.0, 600), 2) - sharp * sharp), 1.0 / std::sqrt(12.0), 0.02);
}

TEST(Chain, AnImageIntensifierVeilsBendsAndIsRound) {
    const FrameDetector panel = detector_preset("flat_panel"), tube = detector_preset("image_intensifier");
    EXPECT_THROW(detector_preset("image_intensifer"), UserError);
    ImageF image(200, 200, 100.0F);
    ImageF flat = image;
    distort(flat, panel, 0.5, Workers());
    EXPECT_EQ(flat.values, image.values);
    for (int y = 90; y < 110; ++y) {
        for (int x = 90; x < 110; ++x) image.values[image.offset(x, y)] = 0.0F;  // a lead square
    }
    distort(image, tube, 0.5, Workers());
    EXPECT_NEAR(image.at(100, 100), 100 * tube.glare, 1.0);  // almost the whole picture's light
    EXPECT_EQ(image.at(3, 3), 0.0F);
    EXPECT_GT(image.at(100, 3), 90.0F);
    const Pincushion bent(tube.pincushion, 200, 200);
    const Vec2 place(170, 60);
    EXPECT_NEAR((bent.pinhole(bent.shown(place)) - place).norm(), 0.0, 1e-6);
    EXPECT_NEAR(bent.shown(Vec2(200, 100)).x(), 204.0, 1e-9);
}

// Modulation transfer by a slanted edge [iec62220-1]: the edge's profile over the distance from it, differentiated and
// transformed at one frequency.
double slanted_edge_mtf(double sigma_mm, double pixel_mm, double cycles_mm) {
    constexpr int size = 256;
    const double slope = std::tan(3.0 * units::deg);
    ImageF image(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x)
            image.values[image.offset(x, y)] = (x - 128) + slope * (y - 128) > 0 ? 1.0F : 0.0F;
    }
    blur(image, sigma_mm / pixel_mm, Workers());
    constexpr int over = 8;  // samples a pixel of the edge's profile
    constexpr int reach = 24;
    std::vector<double> sum(2 * reach * over), count(sum.size());
    for (int y = 64; y < 192; ++y) {
        for (int x = 64; x < 192; ++x) {
            const double place = ((x - 128) + slope * (y - 128)) / std::sqrt(1 + slope * slope);
            const double bin = (place + reach) * over;
            if (bin < 0 || bin >= static_cast<double>(sum.size())) continue;
            sum[static_cast<std::size_t>(bin)] += image.at(x, y);
            count[static_cast<std::size_t>(bin)] += 1;
        }
    }
    double re = 0, im = 0;
    const double f = cycles_mm * pixel_mm;  // cycles a pixel
    for (std::size_t i = 0; i + 1 < sum.size(); ++i) {
        const double line = sum[i + 1] / count[i + 1] - sum[i] / count[i];
        re += line * std::cos(2 * units::pi * f * static_cast<double>(i) / over);
        im += line * std::sin(2 * units::pi * f * static_cast<double>(i) / over);
    }
    // Binning and the finite difference are boxes of 1 / over of a pixel.
    const double box = units::pi * f / over;
    return std::hypot(re, im) / std::pow(std::sin(box) / box, 2);
}

TEST(Chain, ASlantedEdgesModulationIsThatOfTheScintillator) {
    for (const double sigma : {0.12, 0.18, 0.25}) {
        for (const double pixel : {0.1, 0.2, 0.3, 0.4}) {
            const double truth = std::exp(-2 * units::pi * units::pi * sigma * sigma);  // at 1 lp/mm
            EXPECT_NEAR(slanted_edge_mtf(sigma, pixel, 1.0) / truth, 1.0, 0.03) << sigma << " " << pixel;
        }
    }
}

}  // namespace
}  // namespace cathlab
