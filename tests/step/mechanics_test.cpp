// Devices and wall in one step: what is pushed pushes back, and nothing leaves the lumen.
#include <algorithm>
#include <cmath>
#include <set>

#include "contact/penetration.h"
#include "scene/temporary_folder.h"
#include "step/devices.h"
#include "step/rig.h"

namespace cathlab {
namespace {

/// The independent account of how well the devices stay inside, now.
PenetrationReport penetration(const RigRun& run) {
    DeviceSamples samples;
    const CatheterShape shape = run.parts.catheter_route ? run.parts.catheter_route->shape : CatheterShape{};
    begin_samples(run.parts, shape, samples);
    LumenSurfaceState surface;
    update(*run.parts.surface, run.parts.wall_state->x, surface, run.world->workers());
    return penetration_report(*run.parts.surface, surface, samples.list, run.world->workers());
}

class InEveryRig : public testing::TestWithParam<const char*> {};

TEST_P(InEveryRig, MomentumIsHandedOverInFullAndNothingLeavesTheLumen) {
    RigRun run(GetParam());
    double force = 0.0;
    for (int k = 0; k < 150; ++k) {
        run.step(busy_hands(k));
        EXPECT_LT(run.channels.momentum_residual, 1e-6) << k;
        EXPECT_LT(run.channels.wire_penetration_mm, 0.5) << k;
        EXPECT_LT(run.channels.catheter_penetration_mm, 0.5) << k;
        EXPECT_EQ(run.channels.outside_count, 0.0) << k;
        EXPECT_LT(run.channels.wire_stretch_max, 0.01) << k;
        if (k % 10 == 9) {
            const PenetrationReport report = penetration(run);
            EXPECT_LT(report.deepest_mm, 0.5) << k;
            EXPECT_EQ(report.outside, 0) << k;
        }
        force = std::max({force, run.channels.wire_force_mn, run.channels.catheter_force_mn});
    }
    EXPECT_GT(force, 1.0) << "nothing was touched";
    EXPECT_TRUE(run.finite());
}

INSTANTIATE_TEST_SUITE_P(AllThree, InEveryRig, testing::Values("tube_wire", "tube_catheter", "fork"),
                         [](const auto& each) { return std::string(each.param); });

TEST(Devices, DeeperInThanTheirWayGoesAreTheUsersError) {
    for (const char* rig : {"tube_wire", "tube_catheter"}) {
        SceneSpec spec = rig_spec(rig);
        spec.wire.insertion_mm = spec.catheter.insertion_mm = 121.0;  // the tube ends 120 mm beyond the sheath
        try {
            build_world(spec, rig_models(rig), 1, 1);
            ADD_FAILURE() << rig;
        } catch (const UserError& e) {
            EXPECT_NE(std::string(e.what()).find("insertion_mm: found 121"), std::string::npos) << e.what();
        }
    }
}

TEST(Wire, PushedIntoAClosedEndIsRefusedAndStaysInside) {
    RigRun run("tube_wire");
    double last = 0.0;
    for (int k = 0; k < 150; ++k) {
        run.step(push(60.0));
        EXPECT_LT(run.channels.wire_penetration_mm, 0.5) << k;
        EXPECT_GE(run.channels.wire_refused_mm, last) << k;
        last = run.channels.wire_refused_mm;
        if (k % 5 == 4) {
            const PenetrationReport report = penetration(run);
            EXPECT_LT(report.deepest_mm, 0.5) << k;
            EXPECT_EQ(report.outside, 0) << k;
        }
        EXPECT_LT(run.channels.wire_sheath_force_mn, 5500.0) << k << ": the drive slips at 5 N";
    }
    EXPECT_GT(run.channels.wire_refused_mm, 10.0);
    EXPECT_GT(run.count_events("refused"), 10);
    EXPECT_TRUE(run.finite());
}

TEST(Catheter, PushedIntoAClosedEndStaysInside) {
    RigRun run("tube_catheter");
    for (int k = 0; k < 150; ++k) {
        run.step(push(60.0, 1.0));
        EXPECT_LT(run.channels.catheter_penetration_mm, 0.5) << k;
        EXPECT_EQ(run.channels.outside_count, 0.0) << k;
    }
    EXPECT_LT(run.channels.catheter_insertion_mm, 121.0) << "the tube ends 120 mm beyond the sheath";
    EXPECT_GT(run.channels.catheter_insertion_mm, 80.0);
    EXPECT_EQ(penetration(run).outside, 0);
}

TEST(Wire, AtRestAgainstTheWallThePushAtTheSheathIsTheForceOfTheContacts) {
    RigRun run("tube_wire");
    run.step(push(60.0), 100);
    run.step({}, 50);
    const ContactReport report = run.parts.contacts->report(run.parts.wall_state->x);
    ASSERT_FALSE(report.devices.empty());
    // Nothing else holds the wire: along the sheath the hand's push and the wall's answer are one force.
    const double wall = -report.devices.front().force_mn.z();
    EXPECT_GT(wall, 1.0);
    EXPECT_NEAR(run.channels.wire_sheath_force_mn, wall, 0.05 * wall);
}

/// A pull of one direction on some of the wall's particles.
class Pull final : public Effect {
public:
    Pull(std::vector<Index> particles, const Vec3& force) : particles_(std::move(particles)), force_(force) {}
    void force(const EffectContext& /*context*/, std::span<Vec3> force) override {
        for (const Index i : particles_) force[static_cast<std::size_t>(i)] += force_;
    }

private:
    std::vector<Index> particles_;
    Vec3 force_;
};

TEST(Wall, PullingOneBranchLeavesTheOtherWhereItWas) {
    // Branches as long as iliacs: a tube in its tissue is a beam on an elastic foundation, and what reaches the other
    // branch through the fork falls off along the vessels, a factor e every few radii.
    const TemporaryFolder folder;
    SceneSpec spec = rig_spec("fork");
    spec.heart.enabled = spec.wire.enabled = spec.catheter.enabled = false;
    spec.effects = all_effects_off();
    spec.anatomy.file = folder.write("long-fork.toml", R"(
schema = 1
name = "long-fork"
torso = false
[meshing]
voxel_mm = 1.0
face_count = 4500
fine_edge_mm = 1.5
[[region]]
name = "wall"
particle_spacing_mm = 3.0
[[vessel]]
name = "trunk"
region = "wall"
points = [[0.0, 0.0, 0.0, 9.0], [0.0, 0.0, -30.0, 8.5], [0.0, 0.0, -60.0, 8.0]]
[[vessel]]
name = "right"
parent = "trunk"
region = "wall"
fixed_end = true
points = [[0.0, 0.0, -60.0, 5.0], [-15.0, 0.0, -85.0, 5.0], [-40.0, 0.0, -140.0, 4.5], [-50.0, 0.0, -240.0, 4.5]]
[[vessel]]
name = "left"
parent = "trunk"
region = "wall"
fixed_end = true
points = [[0.0, 0.0, -60.0, 5.0], [15.0, 0.0, -85.0, 5.0], [40.0, 0.0, -140.0, 4.5], [50.0, 0.0, -240.0, 4.5]]
)");
    auto world = build_world(spec, {});
    const SoftBodyModel& wall = **world->first<Shared<SoftBodyModel>>();
    std::vector<Index> right, left;  // both below the fork, where they are tubes of their own
    for (std::size_t i = 0; i < wall.size(); ++i) {
        if (wall.rest[i].z() > -85.0) continue;
        (wall.rest[i].x() < 0.0 ? right : left).push_back(static_cast<Index>(i));
    }
    std::set<Index> clusters_right, clusters_left;
    for (const auto& [particles, clusters] : {std::pair{&right, &clusters_right}, std::pair{&left, &clusters_left}})
        for (const Index p : *particles) {
            const auto i = static_cast<std::size_t>(p);
            clusters->insert(wall.cluster.begin() + wall.cluster_start[i],
                             wall.cluster.begin() + wall.cluster_start[i + 1]);
        }
    for (const Index c : clusters_right) EXPECT_FALSE(clusters_left.contains(c)) << "one cluster holds both branches";

    std::vector<Index> pulled;
    for (const Index i : right)
        if (std::fabs(wall.rest[static_cast<std::size_t>(i)].z() + 210.0) < 6.0) pulled.push_back(i);
    ASSERT_GT(pulled.size(), 10U);
    static const EffectInfo info = [] {
        EffectInfo pull;
        pull.name = "pull";
        pull.hooks = hook_force;
        return pull;
    }();
    world->add(world->create("effect.pull"), ActiveEffect{&info, std::make_unique<Pull>(pulled, Vec3(-1.0, 0.0, 0.0))});
    RigRun run(std::move(world));
    run.step({}, 100);
    const auto moved = [&](const std::vector<Index>& particles) {
        double most = 0.0;
        for (const Index p : particles) {
            const auto i = static_cast<std::size_t>(p);
            most = std::max(most, (run.parts.wall_state->x[i] - wall.rest[i]).norm());
        }
        return most;
    };
    std::vector<Index> far_left;
    for (const Index i : left)
        if (wall.rest[static_cast<std::size_t>(i)].z() < -195.0) far_left.push_back(i);
    EXPECT_GT(moved(right), 0.01);
    EXPECT_LT(moved(far_left), 1e-2 * moved(right));
}

TEST(Heart, CarriesTheAnnulusByItsDisplacement) {
    SceneSpec spec = rig_spec("fork");
    spec.wire.enabled = spec.catheter.enabled = false;
    spec.effects = all_effects_off();
    RigRun run(spec, "fork");
    double most = 0.0;
    for (int k = 0; k < 100; ++k) {
        run.step({});
        most = std::max(most, run.channels.heart_displacement_mm);
        EXPECT_NEAR(run.channels.annulus_displacement_mm, run.channels.heart_displacement_mm, 0.5) << k;
    }
    EXPECT_GT(most, 4.0);
}

/// Farthest way of a sample of the catheter in one step while its command stays and the wire goes, mm.
double thrown(RigRun& run, double wire_speed, int steps) {
    double farthest = 0.0;
    for (int k = 0; k < steps; ++k) {
        const CatheterShape before = run.parts.catheter_route->shape;
        Input input = push(wire_speed);
        input.proximal_bend = run.channels.catheter_proximal_bend_deg;
        input.distal_bend = run.channels.catheter_distal_bend_deg;
        run.step(input);
        const CatheterShape& after = run.parts.catheter_route->shape;
        for (std::size_t i = 0; i < std::min(before.points.size(), after.points.size()); ++i)
            farthest = std::max(farthest, (after.points[i] - before.points[i]).norm());
    }
    return farthest;
}

TEST(Catheter, AWireThatComesAndGoesInsideMovesItNoFasterThanContactCanFollow) {
    for (const char* follow : {"vessel", "wire"}) {
        SceneSpec spec = rig_spec("fork");
        spec.catheter.follow = follow;
        RigRun run(spec, "fork");
        Input bend = push(80.0, 1.0);
        bend.proximal_bend = 30.0;
        bend.distal_bend = 40.0;
        run.step(bend, 60);
        const double limit = 4.0 * 0.5 + 1e-9;  // mm a step: 0.5 mm a substep
        EXPECT_LT(thrown(run, 100.0, 60), limit) << follow;
        EXPECT_LT(thrown(run, -100.0, 120), limit) << follow;
        EXPECT_EQ(run.channels.outside_count, 0.0);
    }
}

}  // namespace
}  // namespace cathlab
