#include "softbody/wall_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "core/errors.h"
#include "core/units.h"
#include "rig.h"

namespace cathlab {
namespace {

TEST(Tube, IsClosedAndFacesOutward) {
    const TriMesh mesh = tube_mesh(rig::shape(12.0, 60.0));
    EXPECT_TRUE(find_faults(mesh).sound());
    EXPECT_NEAR(signed_volume(mesh) / (units::pi * 144.0 * 60.0), 1.0, 0.01);
    EXPECT_GT(find_faults(tube_mesh(rig::shape(12.0, 60.0, false))).open_edges, 0U);
}

TEST(WallSample, TheAreasAddUpToTheSurface) {
    const TubeShape tube = rig::shape(12.0, 60.0);
    const WallSample sample = tube_sample(tube, 2.1, 1.0, 1);
    const double sum = std::accumulate(sample.area_mm2.begin(), sample.area_mm2.end(), 0.0);
    const double area = surface_area(tube_mesh(tube));
    EXPECT_NEAR(sum / area, 1.0, 1e-12);
    // A particle for each spacing^2.
    EXPECT_NEAR(static_cast<double>(sample.position.size()) * 2.1 * 2.1 / area, 1.0, 0.12);
}

TEST(WallSample, IsBlueNoise) {
    const WallSample sample = rig::sample();
    double nearest = 1e300;
    for (std::size_t i = 0; i < sample.position.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            nearest = std::min(nearest, (sample.position[i] - sample.position[j]).norm());
    EXPECT_GT(nearest, 0.55 * 2.1);
    const auto [low, high] = std::minmax_element(sample.area_mm2.begin(), sample.area_mm2.end());
    EXPECT_LT(*high / *low, 4.0);
}

// A cell can be enclosed by two others: what is made of them must have no hole beside it.
TEST(WallSample, TheTrianglesAreASheetWithNoMoreRimsThanTheTube) {
    for (const bool closed : {false, true})
        for (std::uint64_t seed = 1; seed <= 8; ++seed)
            for (const double edge : {0.5, 1.0}) {
                TubeShape shape = rig::shape(12.0, 40.0, closed);
                shape.edge_mm = edge;
                const WallSample sample = tube_sample(shape, 1.8, 1.0, seed);
                std::map<Index, Index> rim;  // from each particle on it to the next
                std::set<std::pair<Index, Index>> sides;
                for (const Triangle& t : sample.triangles)
                    for (int k = 0; k < 3; ++k) EXPECT_TRUE(sides.emplace(t[k], t[(k + 1) % 3]).second);
                for (const auto& [a, b] : sides) {
                    if (sides.contains({b, a})) continue;
                    EXPECT_TRUE(rim.emplace(a, b).second);
                }
                int rims = 0;
                for (; !rim.empty(); ++rims)
                    for (auto here = rim.begin(); here != rim.end();) {
                        const Index next = here->second;
                        rim.erase(here);
                        here = rim.find(next);
                    }
                EXPECT_EQ(rims, closed ? 0 : 2) << "seed " << seed << ", edges of " << edge << " mm";
            }
}

TEST(WallSample, TheSameSeedGivesTheSameParticlesAndAnotherOthers) {
    const TubeShape tube = rig::shape(6.0, 30.0);
    const WallSample one = tube_sample(tube, 2.1, 1.0, 5), two = tube_sample(tube, 2.1, 1.0, 5),
                     other = tube_sample(tube, 2.1, 1.0, 6);
    EXPECT_TRUE(one.position == two.position);
    EXPECT_TRUE(one.links == two.links);
    EXPECT_FALSE(one.position == other.position);
}

TEST(WallSample, AtLeastEightParticlesGoRoundEveryLumen) {
    for (const double radius : {0.6, 1.0, 1.75, 3.0, 5.0, 12.0}) {
        TubeShape tube = rig::shape(radius, 12.0 * radius);
        tube.edge_mm = std::min(0.7, 2.0 * units::pi * radius / 36.0);
        const TriMesh mesh = tube_mesh(tube);
        const std::vector<double> wanted(mesh.vertices.size(), 2.1), radii(mesh.vertices.size(), radius);
        const std::vector<double> thickness{1.0};
        const WallSample sample =
            sample_wall(mesh, std::vector<Index>(mesh.vertices.size(), 0), lumen_spacing(wanted, radii), thickness, 3);
        // Round the tube there are at least as many particles as cells that a ring of the surface passes through.
        for (double z = 2.0 * radius; z < 10.0 * radius; z += 0.5 * radius) {
            std::set<std::size_t> cells;
            for (int k = 0; k < 360; ++k) {
                const Vec3 p(radius * std::cos(k * units::deg), radius * std::sin(k * units::deg), z);
                std::size_t best = 0;
                for (std::size_t i = 0; i < sample.position.size(); ++i)
                    if ((sample.position[i] - p).squaredNorm() < (sample.position[best] - p).squaredNorm()) best = i;
                cells.insert(best);
            }
            ASSERT_GE(cells.size(), 8U) << "radius " << radius << " at z " << z;
        }
    }
}

TEST(WallSample, TheSpacingPassesGraduallyIntoAFinerRegion) {
    const TriMesh mesh = tube_mesh([] {
        TubeShape tube = rig::shape(6.0, 60.0);
        tube.edge_mm = 0.35;
        return tube;
    }());
    std::vector<double> spacing;
    for (const Vec3& v : mesh.vertices) spacing.push_back(v.z() < 20.0 ? 1.0 : 2.5);
    const std::vector<double> thickness{1.0};
    const WallSample sample = sample_wall(mesh, std::vector<Index>(mesh.vertices.size(), 0), spacing, thickness, 3);
    const auto mean_spacing = [&](double from, double to) {
        double area = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < sample.position.size(); ++i)
            if (sample.position[i].z() >= from && sample.position[i].z() < to) {
                area += sample.area_mm2[i];
                ++count;
            }
        return std::sqrt(area / count);
    };
    EXPECT_NEAR(mean_spacing(5, 18), 1.0, 0.12);
    EXPECT_NEAR(mean_spacing(30, 55), 2.5, 0.35);
    const double middle = mean_spacing(20.5, 23.5);
    EXPECT_GT(middle, 1.15);
    EXPECT_LT(middle, 2.0);
}

TEST(WallSample, ImpossibleSpacingsAndThicknessesAreRefused) {
    const TriMesh mesh = tube_mesh(rig::shape(6.0, 20.0));
    const std::vector<Index> region(mesh.vertices.size(), 0);
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const std::vector<double> good(mesh.vertices.size(), 2.0), wrong(mesh.vertices.size(), bad);
        const std::vector<double> one{1.0}, bad_one{bad};
        EXPECT_THROW(sample_wall(mesh, region, wrong, one, 1), UserError);
        EXPECT_THROW(sample_wall(mesh, region, good, bad_one, 1), UserError);
    }
    EXPECT_THROW(sample_wall(TriMesh{}, {}, {}, {}, 1), UserError);
}

}  // namespace
}  // namespace cathlab
