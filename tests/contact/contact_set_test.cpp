#include "contact/contact_set.h"

#include <gtest/gtest.h>

#include <numbers>

#include "ball.h"
#include "contact/penetration.h"
#include "shapes.h"

namespace cathlab {
namespace {

using test::Ball;
using test::Surface;

using test::h;

/// A lumen whose particles hang on springs (mN/mm) to their places at rest: every answer has a closed form.
struct SpringWall {
    explicit SpringWall(const TriMesh& mesh, double stiffness = 5.0)
        : surface(mesh), rest(mesh.vertices), x(rest), v(rest.size(), Vec3::Zero()), before(x), k(stiffness) {}

    void predict() {
        before = x;
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * v[i];
        predicted = x;
        update(surface.model, x, surface.state, Workers(1));
    }
    void apply(const ContactSet& contacts) {
        force.assign(x.size(), Vec3::Zero());
        contacts.apply_to_wall(force);
        const double inertia = mass / (h * h);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] = (inertia * predicted[i] + k * rest[i] + force[i]) / (inertia + k);
        }
    }
    void finish() {
        for (std::size_t i = 0; i < x.size(); ++i) v[i] = 0.8 * (x[i] - before[i]) / h;
    }
    std::vector<double> compliance() const { return std::vector<double>(x.size(), 1.0 / (mass / (h * h) + k)); }

    Surface surface;
    std::vector<Vec3> rest, x, v, before, predicted, force;
    double k;
    double mass = 5e-6;
};

struct Bench {
    SpringWall wall;
    Ball ball;
    ContactSet contacts;
    double margin = 1.5;
    int iterations = 2;
    bool forget = false;

    void substep() {
        wall.predict();
        ball.predict();
        std::vector<DeviceSample> samples{ball.sample()};
        if (forget) contacts.clear();
        contacts.detect(wall.surface.model, wall.surface.state, samples, margin, wall.before, wall.compliance(),
                        Workers(1));
        for (int i = 0; i < iterations; ++i) {
            samples[0] = ball.sample();
            contacts.refresh(samples, wall.x);
            ball.solve(contacts.chain_rows(0));
            wall.apply(contacts);
        }
        samples[0] = ball.sample();
        contacts.refresh(samples, wall.x);
        wall.finish();
        ball.finish();
    }
};

Bench resting_ball(double weight_mn) {
    Bench bench{SpringWall(test::straight_tube(8.0, 40.0, 40, 40), 200.0), {}, ContactSet()};
    bench.ball.p = Vec3(0.03, -6.9, 20.2);
    bench.ball.weight = Vec3(0, -weight_mn, 0);
    return bench;
}

TEST(Contact, ADeadWeightReadsItsWeight) {
    for (const double weight : {0.5, 5.0}) {
        Bench bench = resting_ball(weight);
        for (int i = 0; i < 2000; ++i) {
            bench.substep();
            bench.ball.v *= 0.9;  // comes to rest
        }
        const ContactReport report = bench.contacts.report(bench.wall.x);
        EXPECT_NEAR(report.devices.at(0).force_mn.y(), weight, 0.01 * weight);
        EXPECT_NEAR(report.devices.at(0).normal_mn, weight, 0.01 * weight);
        EXPECT_LT(report.penetration_mm, 0.01);
    }
}

TEST(Contact, WarmStartChangesThePathAndNotTheRestingForce) {
    Bench warm = resting_ball(3.0);
    Bench cold = resting_ball(3.0);
    cold.forget = true;
    cold.iterations = 60;
    for (int i = 0; i < 1500; ++i) {
        warm.substep();
        cold.substep();
        warm.ball.v *= 0.9;
        cold.ball.v *= 0.9;
    }
    EXPECT_NEAR(warm.contacts.report(warm.wall.x).devices.at(0).normal_mn,
                cold.contacts.report(cold.wall.x).devices.at(0).normal_mn, 0.01);
    EXPECT_NEAR((warm.ball.p - cold.ball.p).norm(), 0.0, 0.01);
}

TEST(Contact, ActionEqualsReactionInForceAndMoment) {
    const TriMesh mesh = test::straight_tube(3.0, 40.0, 60, 20);
    Surface s(mesh);
    // Each vertex hangs on twelve particles, so that one particle serves many rows.
    PointBinding binding;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        binding.start.push_back(static_cast<Index>(12 * v));
        for (std::size_t j = 0; j < 12; ++j) {
            binding.particle.push_back(static_cast<Index>((v + 7 * j) % mesh.vertices.size()));
            binding.weight.push_back((static_cast<double>(j) + 0.5) / 72.0);
        }
    }
    binding.start.push_back(static_cast<Index>(12 * mesh.vertices.size()));
    const LumenSurfaceModel model = build_lumen_surface(mesh, {}, {}, binding);
    LumenSurfaceState state;
    update(model, mesh.vertices, state, Workers(1));
    std::vector<DeviceSample> samples(200);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        DeviceSample& d = samples[i];
        d.position = state.vertices[2 + 5 * i] + test::uniform_vector(1, i, 0.5);
        d.previous = d.position + test::uniform_vector(2, i, 0.2);
        d.radius = 0.4;
        d.device = static_cast<Index>(i % 2);
        d.arc_mm = static_cast<double>(i);
        d.friction = 0.3;
        d.kinematic = true;
    }
    ContactSet contacts;
    const std::vector<double> compliance(mesh.vertices.size(), 0.2);
    contacts.detect(model, state, samples, 1.5, mesh.vertices, compliance, Workers(1));
    contacts.refresh(samples, mesh.vertices);
    std::vector<Vec3> moved = mesh.vertices;
    contacts.solve_kinematic(samples, moved, compliance, 1);
    const ContactReport report = contacts.report(mesh.vertices);
    EXPECT_GT(report.active, 50);
    EXPECT_LT(report.force_imbalance, 1e-12);
    EXPECT_LT(report.moment_imbalance, 1e-12);

    // The same from outside: what the particles received against what the devices got.
    std::vector<Vec3> force(mesh.vertices.size(), Vec3::Zero());
    contacts.apply_to_wall(force);
    Vec3 wall = Vec3::Zero(), moment = Vec3::Zero();
    for (std::size_t i = 0; i < force.size(); ++i) {
        wall += force[i];
        moment += mesh.vertices[i].cross(force[i]);
    }
    double size = 0.0;
    Vec3 devices = Vec3::Zero(), device_moment = Vec3::Zero();
    for (std::size_t r = 0; r < contacts.rows().size(); ++r) {
        const ChainRow& row = contacts.rows()[r];
        const Vec3 f = row.multiplier * row.normal + row.tangent_force;
        EXPECT_LE(row.tangent_force.norm(), row.friction * row.multiplier * (1 + 1e-12));
        devices += f;
        device_moment += contacts.wall_rows()[r].point.cross(f);
        size += f.norm();
    }
    EXPECT_LT((wall + devices).norm(), 1e-12 * size);
    EXPECT_LT((moment + device_moment).norm(), 1e-12 * size * 40.0);
    EXPECT_LT((report.devices.at(0).force_mn + report.devices.at(1).force_mn - devices).norm(), 1e-12 * size);

    std::vector<Vec3> map(model.triangles.size(), Vec3::Zero());
    contacts.add_triangle_forces(map);
    Vec3 mapped = Vec3::Zero();
    for (const Vec3& f : map) mapped += f;
    EXPECT_LT((mapped + devices).norm(), 1e-12 * size);
    double by_region = 0.0;
    for (const double f : report.region_mn) by_region += f;
    EXPECT_NEAR(by_region, size, 1e-9 * size);
}

TEST(Contact, AKinematicDevicePressedIntoTheWallReadsItsSpring) {
    SpringWall wall(test::straight_tube(8.0, 40.0, 40, 40));
    ContactSet contacts;
    DeviceSample s;
    s.radius = 1.5;
    s.kinematic = true;
    const Index face = 2 * 40 * 20;
    const Triangle& t = wall.surface.model.triangles[face];
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) middle += wall.rest[static_cast<std::size_t>(t[k])] / 3.0;
    s.position = middle + 1.48 * inward_triangle_normal(wall.surface.model, wall.surface.state, face);
    s.previous = s.position;  // 0.02 mm into the wall
    const std::vector<DeviceSample> samples{s};
    for (int i = 0; i < 400; ++i) {
        wall.predict();
        contacts.detect(wall.surface.model, wall.surface.state, samples, 1.5, wall.before, wall.compliance(),
                        Workers(1));
        for (int k = 0; k < 2; ++k) {
            contacts.refresh(samples, wall.x);
            contacts.solve_kinematic(samples, wall.x, wall.compliance(), 1);
            wall.apply(contacts);
        }
        wall.finish();
    }
    contacts.refresh(samples, wall.x);
    const WallRow& row = contacts.wall_rows()[0];
    double compliance = 0.0;  // at rest: particle j moves by w_j f / k, so q moves by sum w_j^2 f / k
    for (std::size_t j = row.begin; j < row.end; ++j)
        compliance += contacts.weights()[j] * contacts.weights()[j] / wall.k;
    const ContactReport report = contacts.report(wall.x);
    EXPECT_NEAR(contacts.rows()[0].gap, 0.0, 1e-4);
    EXPECT_NEAR(report.devices.at(0).normal_mn, 0.02 / compliance, 0.02 * 0.02 / compliance);
}

TEST(Contact, ATipThatYieldsAndTheWallAreTwoSpringsInARow) {
    // Driven 0.02 mm into a wall of compliance C, a tip of compliance c: force 0.02 / (C + c), way c x force.
    for (const double tip_compliance : {0.0, 0.01, 0.2}) {
        SpringWall wall(test::straight_tube(8.0, 40.0, 40, 40));
        ContactSet contacts;
        DeviceSample s;
        s.radius = 1.5;
        s.kinematic = true;
        s.yields = 1.0;
        const Index face = 2 * 40 * 20;
        const Triangle& t = wall.surface.model.triangles[face];
        Vec3 middle = Vec3::Zero();
        for (int k = 0; k < 3; ++k) middle += wall.rest[static_cast<std::size_t>(t[k])] / 3.0;
        const Vec3 driven = middle + 1.48 * inward_triangle_normal(wall.surface.model, wall.surface.state, face);
        TipYield tip;
        tip.compliance_mm_per_mn = tip_compliance;
        tip.most_mm = 1.0;
        tip.most_change_mm = 0.3;
        for (int i = 0; i < 400; ++i) {
            wall.predict();
            s.position = s.previous = driven + tip.way;
            std::vector<DeviceSample> samples{s};
            tip.start = tip.way;
            contacts.detect(wall.surface.model, wall.surface.state, samples, 1.5, wall.before, wall.compliance(),
                            Workers(1));
            for (int k = 0; k < 2; ++k) {
                contacts.refresh(samples, wall.x);
                contacts.solve_kinematic(samples, wall.x, wall.compliance(), 4, &tip);
                samples[0].position = driven + tip.way;
                wall.apply(contacts);
            }
            wall.finish();
        }
        const WallRow& row = contacts.wall_rows()[0];
        double compliance = 0.0;
        for (std::size_t j = row.begin; j < row.end; ++j)
            compliance += contacts.weights()[j] * contacts.weights()[j] / wall.k;
        const double force = contacts.report(wall.x).devices.at(0).normal_mn;
        EXPECT_NEAR(force, 0.02 / (compliance + tip_compliance), 0.02 * force) << tip_compliance;
        EXPECT_NEAR(tip.way.norm(), tip_compliance * force, 1e-6 + 0.001 * tip_compliance * force);
    }
}

TEST(Contact, NoSampleTunnelsAtFullSpeedOrAtTenTimesThat) {
    TriMesh mesh = test::straight_tube(1.5, 40.0, 60, 16);
    test::add_tube(
        mesh, [](double s) { return Vec3(3.3, 0.0, 40.0 * s); }, 1.5, 60, 16);  // a neighbour 0.3 mm away
    for (const double speed : {100.0, 1000.0}) {
        for (std::uint64_t i = 0; i < 40; ++i) {
            Bench bench{
                SpringWall(mesh, 50.0), {}, ContactSet()};  // so stiff that the tubes do not get into each other
            bench.ball.radius = 0.18;
            bench.ball.mass = 2e-5;
            bench.ball.p = Vec3(test::uniform(10, i, -0.8, 0.8), test::uniform(11, i, -0.8, 0.8), 20.0);
            const double phi = test::uniform(12, i, -3.0, 3.0);
            const Vec3 velocity = speed * Vec3(std::cos(phi), std::sin(phi), 0.1);
            double deepest = 0.0;
            for (int k = 0; k < 12; ++k) {
                bench.ball.v = velocity;  // driven on in spite of the wall
                bench.substep();
                const std::vector<DeviceSample> samples{bench.ball.sample()};
                const PenetrationReport report =
                    penetration_report(bench.wall.surface.model, bench.wall.surface.state, samples, Workers(1));
                static_cast<void>(report);
                deepest = std::max(deepest, bench.contacts.report(bench.wall.x).penetration_mm);
                const Vec3 p = bench.ball.p;
                const Vec3 q = bench.contacts.wall_rows().empty() ? p : bench.contacts.wall_rows()[0].point;
                // The wall that holds it is its own: every vertex of the first tube has a lower index.
                if (!bench.contacts.wall_rows().empty()) {
                    const Index corner =
                        bench.wall.surface.model
                            .triangles[static_cast<std::size_t>(bench.contacts.wall_rows()[0].triangle)]
                            .maxCoeff();
                    EXPECT_LT(corner, 60 * 16 + 2) << speed << " run " << i << " substep " << k;
                }
                EXPECT_TRUE(q.allFinite());
            }
            EXPECT_LT(deepest, speed > 500.0 ? 1.0 : 0.2) << speed << " run " << i;
        }
    }
}

TEST(Contact, FrictionHoldsBelowItsConeAndSlidesAboveIt) {
    const double mu = 0.3;
    for (const double slope : {0.2, 0.5}) {  // rise over run
        Bench bench = resting_ball(0.0);
        bench.ball.friction = mu;
        bench.wall.k = 5000.0;  // nearly rigid, so that the ball does not roll in its own dent
        bench.ball.weight = 4.0 * Vec3(0, -1.0, slope) / std::sqrt(1 + slope * slope);
        for (int i = 0; i < 300; ++i) {  // lies down without the pull along the tube
            bench.ball.weight.z() = 0.0;
            bench.substep();
            bench.ball.v *= 0.5;
        }
        bench.ball.weight.z() = 4.0 * slope / std::sqrt(1 + slope * slope);
        const double start = bench.ball.p.z();
        const int steps = 10;
        for (int i = 0; i < steps; ++i) bench.substep();
        const double moved = bench.ball.p.z() - start;
        const double normal = 4.0 / std::sqrt(1 + slope * slope);
        const double pull = 4.0 * slope / std::sqrt(1 + slope * slope);
        if (slope < mu) {
            EXPECT_LT(std::fabs(moved), 0.01);
        } else {
            // implicit Euler from rest: z = a h^2 n (n + 1) / 2
            const double expected = (pull - mu * normal) / bench.ball.mass * h * h * steps * (steps + 1) / 2.0;
            EXPECT_NEAR(moved, expected, 0.05 * expected);
        }
    }
}

TEST(Contact, ATurningWireRubsOnTheWall) {
    SpringWall wall(test::straight_tube(8.0, 40.0, 40, 40));
    DeviceSample s;
    s.radius = 0.5;
    s.position = s.previous = Vec3(0.0, -7.4, 20.0);
    s.arm = Vec3(0, 0, 1.0);
    s.rotation = Vec3(0, 0, 0.1);
    const std::vector<DeviceSample> samples{s};
    ContactSet contacts;
    contacts.detect(wall.surface.model, wall.surface.state, samples, 1.5, wall.before, wall.compliance(), Workers(1));
    contacts.refresh(samples, wall.x);
    ASSERT_EQ(contacts.rows().size(), 1u);
    // The lowest point of a body that turns about +z moves to +x: omega x r with r = -radius * n.
    EXPECT_NEAR(contacts.rows()[0].slip.x(), 0.05, 1e-3);
    EXPECT_NEAR((contacts.rows()[0].arm - Vec3(0, -0.5, 1.0)).norm(), 0.0, 0.05);
}

std::vector<DeviceSample> line_of_samples(double from_arc, int count, double lift) {
    std::vector<DeviceSample> samples;
    for (int i = 0; i < count; ++i) {
        DeviceSample s;
        s.arc_mm = from_arc + 2.0 * i;
        s.position = s.previous = Vec3(0.0, -7.6 + lift, 5.0 + 2.0 * i);
        s.radius = 0.5;
        s.kinematic = true;
        samples.push_back(s);
    }
    return samples;
}

TEST(Contact, FeedingKeepsTheForcesOfTheMaterialPoints) {
    SpringWall wall(test::straight_tube(8.0, 40.0, 40, 40));
    ContactSet contacts;
    const auto detect = [&](const std::vector<DeviceSample>& samples) {
        contacts.detect(wall.surface.model, wall.surface.state, samples, 1.5, wall.before, wall.compliance(),
                        Workers(1));
        contacts.refresh(samples, wall.x);
    };
    std::vector<DeviceSample> samples = line_of_samples(0.0, 6, 0.0);
    detect(samples);
    contacts.solve_kinematic(samples, wall.x, wall.compliance(), 1);
    const double third = contacts.rows()[2].multiplier;
    EXPECT_GT(third, 0.1);
    std::reverse(samples.begin(), samples.end());         // another order of the same samples,
    samples.push_back(line_of_samples(12.0, 1, 0.0)[0]);  // and one more fed in
    detect(samples);
    ASSERT_EQ(contacts.rows().size(), 7u);
    EXPECT_EQ(contacts.rows()[2].multiplier, third);
    EXPECT_EQ(contacts.wall_rows()[2].arc_mm, 4.0);
    EXPECT_EQ(contacts.rows()[6].multiplier, 0.0);
    EXPECT_EQ(contacts.chain_rows(0).size(), 7u);
    EXPECT_TRUE(contacts.chain_rows(1).empty());
}

TEST(Contact, TipAndShaftAreCountedApart) {
    SpringWall wall(test::straight_tube(8.0, 40.0, 40, 40));
    ContactSet contacts;
    const std::vector<DeviceSample> samples = line_of_samples(0.0, 12, 0.0);  // arc 0 to 22: six within 10 mm
    contacts.detect(wall.surface.model, wall.surface.state, samples, 1.5, wall.before, wall.compliance(), Workers(1));
    contacts.refresh(samples, wall.x);
    contacts.solve_kinematic(samples, wall.x, wall.compliance(), 1);
    double tip = 0.0, all = 0.0;
    for (std::size_t r = 0; r < contacts.rows().size(); ++r) {
        all += contacts.rows()[r].multiplier;
        if (contacts.wall_rows()[r].arc_mm <= 10.0) tip += contacts.rows()[r].multiplier;
    }
    const ContactReport report = contacts.report(wall.x);
    EXPECT_NEAR(report.devices.at(0).tip_mn, tip, 1e-9);
    EXPECT_NEAR(report.devices.at(0).total_mn, all, 1e-9);
    EXPECT_EQ(report.devices.at(0).active, 12);
    EXPECT_GT(tip, 0.3 * all);
    EXPECT_LT(tip, 0.7 * all);
}

TEST(Contact, RowsDoNotDependOnTheNumberOfThreads) {
    const TriMesh mesh = test::straight_tube(2.0, 60.0, 90, 16);
    const Surface s(mesh);
    std::vector<DeviceSample> samples(800);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i].position = samples[i].previous = s.state.vertices[i] * 0.9 + Vec3(0, 0, 1.0);
        samples[i].radius = 0.3;
        samples[i].arc_mm = static_cast<double>(i);
    }
    const std::vector<double> compliance(mesh.vertices.size(), 0.2);
    ContactSet one, three;
    for (int repeat = 0; repeat < 2; ++repeat) {
        one.detect(s.model, s.state, samples, 1.5, s.particles, compliance, Workers(1));
        three.detect(s.model, s.state, samples, 1.5, s.particles, compliance, Workers(3));
    }
    ASSERT_EQ(one.rows().size(), three.rows().size());
    for (std::size_t r = 0; r < one.rows().size(); ++r) {
        ASSERT_EQ(one.rows()[r].normal, three.rows()[r].normal);
        ASSERT_EQ(one.rows()[r].compliance, three.rows()[r].compliance);
        ASSERT_EQ(one.wall_rows()[r].triangle, three.wall_rows()[r].triangle);
    }
}

TEST(Contact, AWallThatIsHeldCountsAsAStiffSpring) {
    const Surface s(test::straight_tube(4.0, 20.0, 20, 20));
    DeviceSample d;
    d.position = d.previous = Vec3(3.9, 0, 10);
    d.radius = 0.3;
    d.kinematic = true;
    const std::vector<DeviceSample> samples{d};
    ContactSet contacts;
    contacts.detect(s.model, s.state, samples, 1.5, s.particles, std::vector<double>(s.particles.size(), 0.0),
                    Workers(1));
    contacts.refresh(samples, s.particles);
    std::vector<Vec3> held = s.particles;
    contacts.solve_kinematic(samples, held, std::vector<double>(held.size(), 0.0), 5);
    EXPECT_NEAR(contacts.rows()[0].multiplier, -contacts.rows()[0].gap / 1e-4, 1e-6);
    EXPECT_TRUE(std::isfinite(contacts.rows()[0].multiplier));
}

TEST(Contact, ASampleThatIsNotFiniteIsADevelopersMistake) {
    const Surface s(test::straight_tube(4.0, 20.0, 20, 20));
    DeviceSample d;
    d.radius = 0.3;
    ContactSet contacts;
    const std::vector<double> compliance(s.particles.size(), 0.1);
    const auto refuse = [&](const DeviceSample& bad) {
        const std::vector<DeviceSample> samples{bad};
        EXPECT_THROW(contacts.detect(s.model, s.state, samples, 1.5, s.particles, compliance, Workers(1)),
                     std::logic_error);
    };
    d.position = Vec3(std::nan(""), 0, 0);
    refuse(d);
    d.position = Vec3(0, 0, 5);
    d.radius = 0.0;
    refuse(d);
    d.radius = std::nan("");
    refuse(d);
    EXPECT_THROW(penetration_report(s.model, s.state,
                                    std::vector<DeviceSample>(1,
                                                              [] {
                                                                  DeviceSample bad;
                                                                  bad.position = Vec3(0, INFINITY, 0);
                                                                  return bad;
                                                              }()),
                                    Workers(1)),
                 std::logic_error);
}

TEST(Penetration, CountsWhatIsOutsideAndHowDeep) {
    const Surface s(test::straight_tube(4.0, 40.0, 80, 120));
    std::vector<DeviceSample> samples(4);
    const double x[] = {0.0, 3.9, 4.1, 5.0};
    for (std::size_t i = 0; i < 4; ++i) {
        samples[i].position = Vec3(x[i], 0, 20);
        samples[i].radius = 0.5;
    }
    const PenetrationReport report = penetration_report(s.model, s.state, samples, Workers(1));
    EXPECT_EQ(report.outside, 1);
    EXPECT_EQ(report.deepest_sample, 3);
    EXPECT_NEAR(report.deepest_mm, 1.5, 1e-3);
    EXPECT_NEAR(report.least_clearance_mm, -1.0, 1e-3);
}

}  // namespace
}  // namespace cathlab
