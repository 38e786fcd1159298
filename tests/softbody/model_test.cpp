#include "softbody/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/errors.h"
#include "rig.h"

namespace cathlab {
namespace {

std::vector<std::vector<Index>> members(const SoftBodyModel& model) {
    std::vector<std::vector<Index>> all(model.cluster_count);
    for (std::size_t i = 0; i < model.size(); ++i)
        for (Index m = model.cluster_start[i]; m < model.cluster_start[i + 1]; ++m)
            all[static_cast<std::size_t>(model.cluster[static_cast<std::size_t>(m)])].push_back(static_cast<Index>(i));
    return all;
}

TEST(SoftBodyModel, TheMassIsDensityTimesAreaTimesThickness) {
    const WallSample sample = rig::sample();
    const SoftBodyModel model = build_soft_body(sample, {}, nullptr);
    const double area = std::accumulate(sample.area_mm2.begin(), sample.area_mm2.end(), 0.0);
    EXPECT_NEAR(std::accumulate(model.mass.begin(), model.mass.end(), 0.0), 1.06e-6 * area * 1.0, 1e-15);
    for (std::size_t i = 0; i < model.size(); ++i)
        ASSERT_NEAR(model.stiffness[i] / (model.mass[i] / (reference_step_s * reference_step_s) * 4.0), 1.0, 1e-12);
}

TEST(SoftBodyModel, ThePapersClustersHoldAboutAHundredParticles) {
    const SoftBodyModel model = rig::free_tube();
    const double mean = static_cast<double>(model.membership_count()) / static_cast<double>(model.cluster_count);
    EXPECT_GT(mean, 70.0);
    EXPECT_LT(mean, 150.0);
    for (std::size_t i = 0; i < model.size(); ++i) ASSERT_GT(model.cluster_start[i + 1], model.cluster_start[i]);
}

TEST(SoftBodyModel, AClusterOfACoronaryHoldsNoMoreParticlesThanOneOfTheAorta) {
    const auto largest = [](double radius, double spacing) {
        TubeShape tube = rig::shape(radius, 30.0);
        tube.edge_mm = spacing / 4.0;
        std::size_t most = 0;
        for (const auto& m : members(build_soft_body(tube_sample(tube, spacing, 0.55, 2), {}, nullptr)))
            most = std::max(most, m.size());
        return most;
    };
    EXPECT_LE(static_cast<double>(largest(1.75, 1.0)), 1.2 * static_cast<double>(largest(12.0, 2.1)));
}

TEST(SoftBodyModel, ARadiusTooSmallIsRefusedAndTheSuggestedOneWillDo) {
    const WallSample sample = rig::sample();
    WallParameters parameters;
    parameters.cluster_radius_mm = 5.0;
    try {
        build_soft_body(sample, parameters, nullptr);
        FAIL() << "particles without a cluster were accepted";
    } catch (const UserError& e) {
        const std::string text = e.what();
        const auto number_after = [&](const std::string& words) {
            const std::size_t place = text.find(words);
            return place == std::string::npos ? 0.0 : std::stod(text.substr(place + words.size()));
        };
        WallParameters wider = parameters, denser = parameters;
        wider.cluster_radius_mm = number_after("a radius of at least ");
        denser.cluster_spacing_mm = number_after("a spacing of at most ");
        EXPECT_NO_THROW(build_soft_body(sample, wider, nullptr)) << text;
        EXPECT_NO_THROW(build_soft_body(sample, denser, nullptr)) << text;
    }
}

TEST(SoftBodyModel, ParametersOutOfRangeAreRefusedByName) {
    const WallSample sample = rig::sample(6.0, 20.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [&](auto change, const std::string& name) {
        WallParameters parameters;
        change(parameters);
        try {
            build_soft_body(sample, parameters, nullptr);
            ADD_FAILURE() << name << " was accepted";
        } catch (const UserError& e) {
            EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
        }
    };
    refused([](WallParameters& p) { p.cluster_stiffness = 1.0; }, "cluster_stiffness");
    refused([](WallParameters& p) { p.cluster_stiffness = -0.1; }, "cluster_stiffness");
    refused([&](WallParameters& p) { p.cluster_radius_mm = nan; }, "cluster_radius_mm");
    refused([](WallParameters& p) { p.cluster_spacing_mm = 0.0; }, "cluster_spacing_mm");
    refused([](WallParameters& p) { p.density_kg_mm3 = -1.0; }, "density_kg_mm3");
    refused([](WallParameters& p) { p.damping_per_s = -1.0; }, "damping_per_s");
    refused([](WallParameters& p) { p.regions.emplace_back().cluster_stiffness = 1.5; },
            "cluster_stiffness of a region");
    EXPECT_THROW(build_soft_body(WallSample{}, {}, nullptr), UserError);
}

TEST(SoftBodyModel, ARegionMayHaveItsOwnClustersAndStiffness) {
    WallSample sample = rig::sample(12.0, 80.0);
    for (std::size_t i = 0; i < sample.position.size(); ++i) sample.region[i] = sample.position[i].z() < 40.0 ? 0 : 1;
    WallParameters parameters;
    RegionWall own;
    own.region = 1;
    own.cluster_spacing_mm = 5.0;
    own.cluster_radius_mm = 7.0;
    own.cluster_stiffness = 0.5;
    parameters.regions.push_back(own);
    const SoftBodyModel model = build_soft_body(sample, parameters, nullptr);
    double near = 0.0, far = 0.0;
    int near_count = 0, far_count = 0;
    for (const auto& m : members(model)) {
        double z = 0.0;
        for (const Index i : m) z += model.rest[static_cast<std::size_t>(i)].z() / static_cast<double>(m.size());
        if (z > 15.0 && z < 28.0) near += static_cast<double>(m.size()), ++near_count;
        if (z > 52.0 && z < 70.0) far += static_cast<double>(m.size()), ++far_count;
    }
    EXPECT_GT(near / near_count, 2.0 * far / far_count);
    for (std::size_t i = 0; i < model.size(); ++i)
        ASSERT_NEAR(model.stiffness[i] * reference_step_s * reference_step_s / model.mass[i],
                    model.region[i] == 1 ? 1.0 : 4.0, 1e-9);
}

/// Two tubes side by side with a gap of 2 mm.
WallSample neighbours(std::size_t& split) {
    WallSample both = rig::sample(5.0, 60.0);
    split = both.position.size();
    TubeShape tube = rig::shape(5.0, 60.0);
    tube.start = Vec3(12.0, 0, 0);
    const WallSample other = tube_sample(tube, 2.1, 1.0, 8);
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(both.position, other.position);
    append(both.normal, other.normal);
    append(both.area_mm2, other.area_mm2);
    append(both.thickness_mm, other.thickness_mm);
    append(both.region, other.region);
    for (const auto& [a, b] : other.links)
        both.links.emplace_back(a + static_cast<Index>(split), b + static_cast<Index>(split));
    return both;
}

TEST(SoftBodyModel, NoClusterHoldsParticlesOfTwoVesselsAndPullingOneLeavesTheOther) {
    std::size_t split = 0;
    const WallSample sample = neighbours(split);
    const auto ends = [](const Vec3& p) { return p.z() < 1.5 || p.z() > 58.5; };
    rig::Wall wall(build_soft_body(sample, {}, ends));
    for (const auto& m : members(wall.model)) {
        const bool first = static_cast<std::size_t>(m.front()) < split;
        for (const Index i : m) ASSERT_EQ(static_cast<std::size_t>(i) < split, first);
    }
    std::vector<Vec3> pull(wall.model.size(), Vec3::Zero());
    for (std::size_t i = 0; i < split; ++i)
        if (wall.model.rest[i].z() > 25.0 && wall.model.rest[i].z() < 35.0) pull[i] = Vec3(8, 4, 0);
    // What the other does alone: rounding of its fits at rest, nothing more.
    rig::Wall alone(build_soft_body(sample, {}, ends));
    for (int k = 0; k < 100; ++k) {
        wall.step(0.004, 2, {}, pull);
        alone.step(0.004, 2);
    }
    double moved = 0.0;
    for (std::size_t i = 0; i < split; ++i) moved = std::max(moved, (wall.state.x[i] - wall.model.rest[i]).norm());
    EXPECT_GT(moved, 1.0);
    for (std::size_t i = split; i < wall.model.size(); ++i) {
        ASSERT_TRUE(wall.state.x[i] == alone.state.x[i]);
        ASSERT_LT((wall.state.x[i] - wall.model.rest[i]).norm(), 1e-9);
    }
}

TEST(SoftBodyModel, ClustersOfOneOrTwoParticlesAndFlatOnesStayFinite) {
    WallSample sample;
    const auto add = [&](const Vec3& p) {
        sample.position.push_back(p);
        sample.normal.emplace_back(0, 0, 1);
        sample.area_mm2.push_back(4.0);
        sample.thickness_mm.push_back(1.0);
        sample.region.push_back(0);
        return static_cast<Index>(sample.position.size() - 1);
    };
    add(Vec3(0, 0, 0));                                            // alone
    const Index a = add(Vec3(50, 0, 0)), b = add(Vec3(52, 0, 0));  // a pair
    sample.links.emplace_back(a, b);
    Index last = add(Vec3(100, 0, 0));  // a line
    for (int k = 1; k < 6; ++k) {
        const Index next = add(Vec3(100 + 2 * k, 0, 0));
        sample.links.emplace_back(last, next);
        last = next;
    }
    for (int k = 0; k < 16; ++k) {  // a plane
        const int column = k % 4, row = k / 4;
        const Index here = add(Vec3(150.0 + 2.0 * column, 2.0 * row, 0.0));
        if (k % 4 > 0) sample.links.emplace_back(here - 1, here);
        if (k >= 4) sample.links.emplace_back(here - 4, here);
    }
    for (const Precision precision : {Precision::double_, Precision::float_}) {
        WallParameters parameters;
        parameters.precision = precision;
        rig::Wall wall(build_soft_body(sample, parameters, nullptr));
        EXPECT_EQ(wall.model.free_bodies.size(), 4U);
        rig::shake(wall, 200.0);
        for (int k = 0; k < 200; ++k) wall.step(0.004, 2);
        for (const Vec3& x : wall.state.x) ASSERT_TRUE(x.allFinite());
    }
}

}  // namespace
}  // namespace cathlab
