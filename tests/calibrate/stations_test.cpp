// Stations of a vessel tree: found, cut out, loaded; and refused where they cannot be.
#include "calibrate/stations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibrate/rig_run.h"
#include "core/errors.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

/// A straight vessel of radius 10 mm about z from 0 to 160 mm in two regions, a third without a centre-line, and a
/// narrow branch from its middle whose wall is left out.
AnatomyModel straight_anatomy() {
    AnatomyModel out;
    out.name = "straight";
    const TubeShape shape{.radius_mm = 10.0, .length_mm = 160.0, .edge_mm = 1.0, .closed = true};
    out.fine = tube_mesh(shape);
    for (const Vec3& p : out.fine.vertices) out.fine_region.push_back(p.z() < 80.0 ? 0 : 1);
    out.fine_radius.assign(out.fine.vertices.size(), 10.0);
    for (const char* name : {"lower", "upper", "painted", "branch"}) {
        Region region;
        region.name = name;
        region.wall_thickness_mm = 1.5;
        out.regions.push_back(region);
    }
    for (int i = 0; i <= 80; ++i) {
        out.centreline.nodes.push_back({Vec3(0.0, 0.0, 2.0 * i), 10.0, i < 40 ? 0 : 1});
        if (i > 0) out.centreline.edges.emplace_back(i - 1, i);
    }
    for (int i = 1; i <= 20; ++i) {
        out.centreline.nodes.push_back({Vec3(2.0 * i, 0.0, 80.0), 3.0, 3});
        out.centreline.edges.emplace_back(i == 1 ? 40 : 80 + i - 1, 80 + i);
    }
    out.landmarks.push_back({"middle", Pose{Vec3(0.0, 0.0, 80.0), Quat::Identity()}, 10.0, 40});
    return out;
}

SceneRigStation station(const std::string& name, const std::string& region) {
    SceneRigStation out;
    out.name = name;
    out.region = region;
    out.where = {"rig.toml", 7, "[[rig.station]]"};
    return out;
}

SceneRig rig_of(std::vector<SceneRigStation> stations) {
    SceneRig out;
    out.kind = "stations";
    out.where = {"rig.toml", 5, "[rig]"};
    out.stations = std::move(stations);
    return out;
}

std::string complaint(const SceneRig& rig) {
    const AnatomyModel anatomy = straight_anatomy();
    return error_sentence([&] { station_wall(anatomy, rig); });
}

TEST(Stations, StandInTheMiddleOfTheirRegionOrWhereTheyAreToldTo) {
    SceneRigStation told = station("told", "upper");
    told.place_mm = 50.0;
    const StationWall wall = station_wall(straight_anatomy(), rig_of({station("own", "lower"), told}));
    ASSERT_EQ(wall.stations.size(), 2U);
    EXPECT_NEAR(wall.stations[0].place.z(), 39.0, 1e-9);  // nodes of "lower": z from 0 to 78
    EXPECT_NEAR(wall.stations[1].place.z(), 130.0, 1e-9);
    EXPECT_NEAR(wall.stations[0].radius_mm, 10.0, 1e-9);
    EXPECT_NEAR(wall.stations[0].axis.z(), 1.0, 1e-9);
    EXPECT_EQ(find_faults(wall.mesh).non_manifold_edges, 0U);
    for (const Vec3& p : wall.mesh.vertices)
        EXPECT_LE(std::min(std::fabs(p.z() - 39.0), std::fabs(p.z() - 130.0)), 30.0 + 1e-9);
}

TEST(Stations, OfALandmarkGoOnAlongTheWiderVessel) {
    SceneRigStation at_landmark = station("here", "");
    at_landmark.landmark = "middle";
    const StationWall wall = station_wall(straight_anatomy(), rig_of({at_landmark}));
    EXPECT_NEAR(wall.stations[0].place.z(), 80.0, 1e-9);
    for (const Vec3& p : wall.stations[0].path) EXPECT_NEAR(p.x(), 0.0, 1e-9);
    EXPECT_LT(wall.stations[0].arc.front(), -30.0);
    EXPECT_GT(wall.stations[0].arc.back(), 30.0);
}

TEST(Stations, WithoutNamesOneStandsInEachWideRegion) {
    const StationWall wall = station_wall(straight_anatomy(), rig_of({}));
    ASSERT_EQ(wall.stations.size(), 2U);
    EXPECT_EQ(wall.stations[0].name, "lower");
    EXPECT_EQ(wall.stations[1].name, "upper");
}

TEST(Stations, PushOverTwoRadiiAndAHalfReadOverHalfOfOneAndHoldTheEnds) {
    const StationWall wall = station_wall(straight_anatomy(), rig_of({station("a", "lower"), station("b", "upper")}));
    const Specimen specimen = station_specimen(wall, SceneWall{}, RigStress::nominal, 1);
    ASSERT_EQ(specimen.gauges.size(), 2U);
    const double z0 = wall.stations[0].place.z();
    for (std::size_t i = 0; i < specimen.sample.position.size(); ++i) {
        const Vec3& p = specimen.sample.position[i];
        const Vec3 radial(p.x(), p.y(), 0.0);
        const Vec3& f = specimen.gauges[0].push[i];
        const bool loaded = std::fabs(p.z() - z0) <= 25.0 && radial.norm() > 9.9;
        EXPECT_EQ(f.norm() > 0.0, loaded || (std::fabs(p.z() - z0) <= 25.0 && f.norm() > 0.0));
        if (loaded) {
            EXPECT_NEAR(f.dot(radial.normalized()), 1.5 / 10.0 * specimen.sample.area_mm2[i], 1e-9);
        }
        if (specimen.held[i]) {
            EXPECT_EQ(f.norm(), 0.0);
        }
    }
    EXPECT_GT(std::count(specimen.held.begin(), specimen.held.end(), 1), 40);
    EXPECT_NEAR(specimen.gauges[0].radius_mm, 10.0, 1e-6);
    EXPECT_NEAR(specimen.gauges[0].thickness_mm, 1.5, 1e-12);
    std::vector<Vec3> x = specimen.sample.position;
    for (Vec3& p : x) p = Vec3(1.1 * p.x(), 1.1 * p.y(), p.z()) + Vec3(2.0, 1.0, 0.0);
    EXPECT_NEAR(specimen.gauges[0].strain(x), 0.1, 1e-4);
}

TEST(Stations, OfAStraightVesselGiveWayAsATubeOfItsSizeDoes) {
    WallRig tube, stations;
    tube.shape.radius_mm = 10.0;
    tube.thickness_mm = 1.5;
    stations.kind = RigKind::stations;
    stations.stations = std::make_shared<const StationWall>(
        station_wall(straight_anatomy(), rig_of({station("a", "lower"), station("b", "upper")})));
    SceneSpec scene;
    scene.wall.particle_spacing_mm = 2.1;
    const std::vector<double> stress{20.0, 60.0};
    const auto t = rig_strain(tube, scene, stress);
    const auto s = rig_strain(stations, scene, stress);
    ASSERT_EQ(s.size(), 2U);
    for (std::size_t k = 0; k < stress.size(); ++k)
        for (std::size_t g = 0; g < 2; ++g) EXPECT_NEAR(s[g][k] / t[0][k], 1.0, 0.1) << g << " " << k;
}

// Between its held ends, which do not widen, a piece is a tube whose length is held: mu (l - l^(-2 a - 1)),
// a = nu / (1 - nu), is its force by the section at rest (softbody/shell.h).
TEST(Stations, OfAnElasticVesselAreTheThinWallsOne) {
    WallRig rig;
    rig.kind = RigKind::stations;
    rig.stress = RigStress::nominal;
    rig.stations = std::make_shared<const StationWall>(
        station_wall(straight_anatomy(), rig_of({station("a", "lower"), station("b", "upper")})));
    SceneSpec scene;
    scene.wall.form = "elastic";
    scene.wall.young_kpa = 400.0;
    scene.wall.poisson = 0.45;
    const std::vector<double> stress{20.0, 60.0};
    const auto strain = rig_strain(rig, scene, stress);
    const double mu = 0.5 * 400.0 / 1.45, a = 0.45 / 0.55;
    for (const std::vector<double>& gauge : strain)
        for (std::size_t k = 0; k < stress.size(); ++k) {
            const double l = 1.0 + gauge[k];
            EXPECT_NEAR(mu * (l - std::pow(l, -2.0 * a - 1.0)) / stress[k], 1.0, 0.04) << gauge[k];
        }
}

TEST(Stations, NeitherHeartNorBreathingNorTissueMovesTheRig) {
    WallRig rig;
    rig.kind = RigKind::stations;
    rig.stations =
        std::make_shared<const StationWall>(station_wall(straight_anatomy(), rig_of({station("a", "lower")})));
    SceneSpec scene, busy;
    scene.wall.particle_spacing_mm = busy.wall.particle_spacing_mm = 3.0;
    busy.heart.enabled = true;
    busy.wall.surrounding_kpa_per_mm = 5.0;
    for (SceneEffect& effect : busy.effects)
        if (effect.info->name == "respiration") effect.enabled = true;
    const std::vector<double> stress{30.0};
    EXPECT_EQ(rig_strain(rig, scene, stress), rig_strain(rig, busy, stress));
}

TEST(Stations, ThatCannotBeAreToldWithTheirPlaceAndTheNearestName) {
    const auto has = [](const std::string& sentence, const std::string& part) {
        EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    };
    has(complaint(rig_of({station("a", "uper")})), "rig.toml:7");
    has(complaint(rig_of({station("a", "uper")})), "did you mean 'upper'");
    has(complaint(rig_of({station("a", "painted")})), "no centre-line");
    has(complaint(rig_of({station("a", "")})), "either a region or a landmark");
    SceneRigStation both = station("a", "upper");
    both.landmark = "middle";
    has(complaint(rig_of({both})), "either a region or a landmark");
    both.region.clear();
    both.landmark = "midle";
    has(complaint(rig_of({both})), "did you mean 'middle'");
    both.landmark = "middle";
    both.place_mm = 3.0;
    has(complaint(rig_of({both})), "place_mm runs along a region");
    SceneRigStation far = station("a", "upper");
    far.place_mm = 100.0;
    has(complaint(rig_of({far})), "80 mm long");
    far.place_mm = 75.0;
    has(complaint(rig_of({far})), "pushed over 25 mm");
    SceneRigStation near = station("b", "lower");
    near.place_mm = 55.0;
    has(complaint(rig_of({station("a", "lower"), near})), "too near to 'a'");
    has(complaint(rig_of({station("a", "lower"), station("a", "upper")})), "second station");

    AnatomyModel narrow = straight_anatomy();
    for (CentrelineNode& node : narrow.centreline.nodes) node.radius = 4.0;
    has(error_sentence([&] { station_wall(narrow, rig_of({})); }), "no region");
    AnatomyModel flat = straight_anatomy();
    for (CentrelineNode& node : flat.centreline.nodes) node.radius = 0.0;
    has(error_sentence([&] { station_wall(flat, rig_of({station("a", "lower")})); }), "radius");
    AnatomyModel bare = straight_anatomy();
    for (Vec3& p : bare.fine.vertices) p.x() += 500.0;
    has(error_sentence([&] { station_wall(bare, rig_of({station("a", "lower")})); }), "no wall");
}

}  // namespace
}  // namespace cathlab
