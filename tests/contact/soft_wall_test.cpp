// Contact against the true soft wall: clusters, skinned surface, and a point mass or a wire.
#include <gtest/gtest.h>

#include "ball.h"
#include "contact/contact_set.h"
#include "contact/penetration.h"
#include "contact/push_out.h"
#include "core/deterministic_math.h"
#include "device_samples.h"
#include "shapes.h"
#include "softbody/solver.h"
#include "softbody/tube.h"

namespace cathlab {
namespace {

using test::Ball;
using test::h;

struct SoftWall {
    explicit SoftWall(double radius, double length, int threads = 1, double spacing = 2.1) : workers(threads) {
        TubeShape shape;
        shape.radius_mm = radius;
        shape.length_mm = length;
        shape.edge_mm = std::min(0.5, radius / 4.0);
        const WallSample sample = tube_sample(shape, spacing, 1.0, 3);
        model = build_soft_body(sample, {}, [&](const Vec3& p) { return p.z() < 4.0 || p.z() > length - 4.0; });
        shape.edge_mm = std::min(1.4, 2.0 * 3.14159 * radius / 14.0);
        const TriMesh lumen = tube_mesh(shape);
        surface = build_lumen_surface(lumen, {}, {}, bind_points(model, lumen.vertices, 10, true));
        state = rest_state(model);
        update(surface, state.x, surface_state, workers);
    }
    void predict_all() {
        predict(model, state, scratch, h, {}, workers);
        update(surface, state.x, surface_state, workers);
    }
    void detect(ContactSet& contacts, std::span<const DeviceSample> samples) {
        contacts.detect(surface, surface_state, samples, 1.5, scratch.start, scratch.compliance, workers);
    }
    void apply_rows(const ContactSet& contacts) {
        std::fill(scratch.force.begin(), scratch.force.end(), Vec3::Zero());
        contacts.apply_to_wall(scratch.force);
        apply(model, state, scratch, h, workers);
    }
    void finish_all() {
        finish(model, state, scratch, h, workers);
        update(surface, state.x, surface_state, workers);
    }

    Workers workers;
    SoftBodyModel model;
    SoftBodyState state;
    SoftBodyScratch scratch;
    LumenSurfaceModel surface;
    LumenSurfaceState surface_state;
};

void substep(SoftWall& wall, Ball& ball, ContactSet& contacts) {
    wall.predict_all();
    ball.predict();
    std::vector<DeviceSample> samples{ball.sample()};
    wall.detect(contacts, samples);
    for (int i = 0; i < 2; ++i) {
        solve_goals(wall.model, wall.state, wall.scratch, wall.workers);
        wall.apply_rows(contacts);  // where the wall stands under the forces so far: the rows' gaps are measured there
        samples[0] = ball.sample();
        contacts.refresh(samples, wall.state.x);
        ball.solve(contacts.chain_rows(0));
        wall.apply_rows(contacts);
    }
    samples[0] = ball.sample();
    contacts.refresh(samples, wall.state.x);
    wall.finish_all();
    ball.finish();
}

TEST(SoftWall, ADeadWeightReadsItsWeight) {
    for (const double weight : {2.0, 50.0}) {  // mN
        SoftWall wall(9.0, 50.0);
        ContactSet contacts;
        Ball ball;
        ball.radius = 1.0;
        ball.mass = 5e-3;
        ball.friction = 0.2;
        ball.p = Vec3(0.1, -7.8, 25.2);
        ball.weight = Vec3(0, -weight, 0);
        ContactReport report;
        for (int i = 0; i < 600; ++i) {
            substep(wall, ball, contacts);
            ball.v *= 0.8;
        }
        report = contacts.report(wall.state.x);
        EXPECT_NEAR(report.devices.at(0).force_mn.y(), weight, 0.01 * weight);
        EXPECT_NEAR(report.devices.at(0).normal_mn, weight, 0.01 * weight);
        EXPECT_LT(report.penetration_mm, 0.02);
        EXPECT_LT(report.force_imbalance, 1e-12);
        EXPECT_LT(report.moment_imbalance, 1e-12);
        EXPECT_LT(ball.v.norm(), 0.5);
    }
}

TEST(SoftWall, AFastSampleIsStoppedAndTheWallGivesWay) {
    for (const double speed : {100.0, 1000.0}) {
        SoftWall wall(3.0, 40.0, 1, 1.8);
        ContactSet contacts;
        Ball ball;
        ball.radius = 0.45;
        ball.mass = 2e-5;
        ball.p = Vec3(0.2, 0.1, 20.0);
        double deepest = 0.0;
        for (int i = 0; i < 40; ++i) {
            ball.v = speed * Vec3(0.8, 0.6, 0.05);
            substep(wall, ball, contacts);
            const std::vector<DeviceSample> samples{ball.sample()};
            const PenetrationReport report =
                penetration_report(wall.surface, wall.surface_state, samples, wall.workers);
            EXPECT_EQ(report.outside, 0) << speed << " substep " << i;
            deepest = std::max(deepest, report.deepest_mm);
        }
        EXPECT_LT(deepest, speed > 500.0 ? 1.5 : 0.3) << speed;
        double pushed = 0.0;
        for (std::size_t i = 0; i < wall.state.x.size(); ++i) {
            pushed = std::max(pushed, (wall.state.x[i] - wall.model.rest[i]).norm());
        }
        EXPECT_GT(pushed, 0.001);
        EXPECT_LT(contacts.report(wall.state.x).force_imbalance, 1e-12);
    }
}

WireSpec wire_spec() {
    WireSpec spec;
    spec.name = "test";
    spec.length_mm = 400.0;
    spec.link_length_mm = 3.0;
    WireSection section;
    section.length_mm = 400.0;
    section.diameter_mm = 0.889;
    section.bending_stiffness_n_mm2 = 1850.0;
    section.torsion_stiffness_n_mm2 = 1400.0;
    section.axial_stiffness_n = 37000.0;
    section.density_kg_m3 = 7900.0;
    section.material = "steel";
    spec.sections = {section};
    spec.source = "test";
    return spec;
}

struct WireRun {
    SoftWall wall;
    Rod rod;
    ContactSet contacts;
    WireSamples samples;
    std::vector<DeviceSample> now;
    double deepest = 0.0, imbalance = 0.0;
    Index outside = 0;

    void substep(double advance, double turn) {
        samples.begin(rod);
        rod.command(advance, turn);
        wall.predict_all();
        rod.predict(h);
        now.clear();
        samples.append(rod, now);
        wall.detect(contacts, now);
        for (int i = 0; i < 2; ++i) {
            solve_goals(wall.model, wall.state, wall.scratch, wall.workers);
            wall.apply_rows(contacts);
            now.clear();
            samples.append(rod, now);
            contacts.refresh(now, wall.state.x);
            rod.solve(h, contacts.chain_rows(0));
            wall.apply_rows(contacts);
        }
        wall.finish_all();
        rod.finish(h);
        now.clear();
        samples.append(rod, now);
        contacts.refresh(now, wall.state.x);
        const PenetrationReport report = penetration_report(wall.surface, wall.surface_state, now, wall.workers);
        deepest = std::max(deepest, report.deepest_mm);
        outside += report.outside;
        imbalance = std::max(imbalance, contacts.report(wall.state.x).force_imbalance);
    }
};

WireRun wire_against_the_side(int threads) {
    SheathPose sheath;
    sheath.mouth.position = Vec3(0, 0, 5.0);
    sheath.mouth.orientation = det::rotation_between(Vec3::UnitZ(), Vec3(0.25, 0.05, 1.0).normalized());
    return {SoftWall(8.0, 120.0, threads), Rod(wire_spec(), sheath, 12.0), ContactSet(), WireSamples(0, 0.1, 1.5), {}};
}

TEST(SoftWall, AStiffWirePushedAtFullSpeedStaysInside) {
    WireRun run = wire_against_the_side(1);
    for (int i = 0; i < 240; ++i) run.substep(0.4, 0.025);  // 100 mm/s, 360 deg/s
    EXPECT_EQ(run.outside, 0);
    EXPECT_LT(run.deepest, 0.5);
    EXPECT_LT(run.imbalance, 1e-12);
    EXPECT_GT(run.contacts.report(run.wall.state.x).active, 3);
}

TEST(SoftWall, AWireInTheWallIsTheSameOnAnyNumberOfThreads) {
    WireRun one = wire_against_the_side(1);
    WireRun three = wire_against_the_side(3);
    for (int i = 0; i < 60; ++i) {
        one.substep(0.4, 0.01);
        three.substep(0.4, 0.01);
    }
    for (std::size_t i = 0; i < one.wall.state.x.size(); ++i) ASSERT_EQ(one.wall.state.x[i], three.wall.state.x[i]);
    ASSERT_EQ(one.rod.tip(), three.rod.tip());
}

TEST(PushOut, WhatIsTooDeepIsTakenOutByMovingTheWallAlone) {
    SoftWall wall(5.0, 40.0);
    wall.predict_all();
    // One sample beyond the wall, one a little in it, one that touches nothing.
    std::vector<DeviceSample> samples(3);
    samples[0].position = Vec3(0.0, -5.6, 20.0);
    samples[1].position = Vec3(4.3, 0.0, 12.0);
    samples[2].position = Vec3(0.0, 0.0, 30.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i].previous = 0.5 * samples[i].position + Vec3(0.0, 0.0, 0.5 * samples[i].position.z());
        samples[i].radius = 0.8;
        samples[i].arc_mm = 10.0 * static_cast<double>(i);
    }
    ContactSet contacts;
    wall.detect(contacts, samples);
    ASSERT_GE(contacts.rows().size(), 2u);
    const std::vector<ChainRow> before(contacts.rows().begin(), contacts.rows().end());
    const std::vector<Vec3> velocity = wall.state.v;
    std::vector<Vec3> places;
    for (const DeviceSample& s : samples) places.push_back(s.position);
    const TreePart near = part_near(wall.surface.tree, wall.surface_state.boxes, places, 4.5);
    const double left = push_out(wall.surface, near, with_rows(contacts), samples, 0.2, wall.scratch.compliance,
                                 wall.state.x, wall.surface_state, wall.workers);
    EXPECT_LT(left, 0.22);
    update(wall.surface, wall.state.x, wall.surface_state, wall.workers);
    const PenetrationReport report = penetration_report(wall.surface, wall.surface_state, samples, wall.workers);
    EXPECT_LT(report.deepest_mm, 0.22);
    EXPECT_EQ(report.outside, 0);
    for (std::size_t r = 0; r < before.size(); ++r) EXPECT_EQ(contacts.rows()[r].multiplier, before[r].multiplier);
    EXPECT_EQ(wall.state.v, velocity);
    for (std::size_t i = 0; i < wall.model.size(); ++i) {
        const Vec3 moved = wall.state.x[i] - wall.model.rest[i];
        if (wall.model.fixed[i] || std::fabs(wall.model.rest[i].z() - 30.0) < 3.0) {
            EXPECT_EQ(moved.norm(), 0.0) << i;
        }
        EXPECT_LT(moved.norm(), 4.0) << i;
    }
}

TEST(PushOut, NeighboursMoveTheWallOnceAndNotEachAnew) {
    SoftWall wall(5.0, 40.0);
    wall.predict_all();
    // A shaft along the wall, 0.6 mm too deep at each of its samples.
    std::vector<DeviceSample> samples;
    for (int i = 0; i <= 32; ++i) {
        const double z = 16.0 + 0.25 * i;
        samples.emplace_back();
        samples.back().position = Vec3(0.0, -4.8, z);
        samples.back().previous = Vec3(0.0, -4.0, z);
        samples.back().radius = 0.8;
        samples.back().arc_mm = z;
    }
    ContactSet contacts;
    wall.detect(contacts, samples);
    std::vector<Vec3> places;
    for (const DeviceSample& s : samples) places.push_back(s.position);
    const TreePart near = part_near(wall.surface.tree, wall.surface_state.boxes, places, 4.5);
    const double left = push_out(wall.surface, near, with_rows(contacts), samples, 0.2, wall.scratch.compliance,
                                 wall.state.x, wall.surface_state, wall.workers);
    EXPECT_LT(left, 0.22);
    update(wall.surface, wall.state.x, wall.surface_state, wall.workers);
    for (const DeviceSample& s : samples) {
        const SurfacePoint point = closest(wall.surface, wall.surface_state, s.position, 4.0);
        // 1.4 mm clear of it, where each moves it by all of its own depth.
        EXPECT_LT(point.signed_distance - s.radius, 0.5) << "at " << s.arc_mm;
    }
}

TEST(PushOut, BesideAFixedEndNoParticleIsThrownAbout) {
    // Between the fixed ring and the free wall a point's free particles may weigh a thousandth of it.
    for (double z = 0.25; z < 8.0; z += 0.25) {
        SoftWall wall(5.0, 40.0);
        wall.predict_all();
        std::vector<DeviceSample> samples(1);
        samples[0].position = Vec3(5.0, 0.3, z);
        samples[0].previous = Vec3(4.0, 0.3, z);
        samples[0].radius = 1.0;
        ContactSet contacts;
        wall.detect(contacts, samples);
        const TreePart near =
            part_near(wall.surface.tree, wall.surface_state.boxes, std::vector<Vec3>{samples[0].position}, 4.5);
        push_out(wall.surface, near, with_rows(contacts), samples, 0.2, wall.scratch.compliance, wall.state.x,
                 wall.surface_state, wall.workers);
        for (std::size_t i = 0; i < wall.model.size(); ++i)
            EXPECT_LT((wall.state.x[i] - wall.model.rest[i]).norm(), 4.0 + 1e-9) << "at " << z << " mm, particle " << i;
    }
}

}  // namespace
}  // namespace cathlab
