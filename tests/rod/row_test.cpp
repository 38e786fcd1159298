// Contact rows: the force that a row returns is the force that the chain felt.
#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "rod_fixture.h"

namespace cathlab {
namespace {

Vec3 momentum(const Rod& rod) {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < rod.free_link_count(); ++i) p += rod.link_mass(i) * rod.link_velocity(i);
    return p;
}

ChainRow row_at(Index link, const Vec3& normal, double gap, double compliance) {
    ChainRow row;
    row.link = link;
    row.normal = normal;
    row.gap = gap;
    row.compliance = compliance;
    return row;
}

TEST(Row, AStopUnderTheTipReturnsTheForceThatPressesIt) {
    // A cantilever pressed at the tip's centre against a soft stop at the same point: the stop takes what the wire's
    // own stiffness does not, F / (1 + c 3EI/L^3).
    const WireSpec spec = test::bmw();
    Rod rod(spec, {}, 100.0);
    const Vec3 rest = rod.link_pose(0).position;
    const double force = 40.0, compliance = 0.01, arm = 100.0 - 0.5 * rod.link_length(0);
    const double wire = 3.0 * 75e3 / (arm * arm * arm);
    const std::vector<Vec3> push{Vec3(0.0, -force, 0.0)};
    std::vector<ChainRow> rows{row_at(0, Vec3::UnitY(), 0.0, compliance)};
    double stop = 0.0;  // where the stop stands: it gives way by compliance x multiplier
    for (int i = 0; i < 300; ++i) {
        rod.command(0.0, 0.0);
        rod.predict(0.1, push);
        for (int k = 0; k < 2; ++k) {
            rows[0].gap = rod.link_pose(0).position.y() - rest.y() - stop;
            rod.solve(0.1, rows);
            stop = -compliance * rows[0].multiplier;
        }
        rod.finish(0.1);
    }
    EXPECT_NEAR(rows[0].multiplier, force / (1.0 + compliance * wire), 1e-3 * force);
    EXPECT_NEAR(rod.link_pose(0).position.y() - rest.y(), stop, 1e-9);
}

TEST(Row, ForcesOfRowsSheathAndBloodMakeUpTheChangeOfMomentum) {
    Rod rod(test::amplatz(), {}, 200.0);
    const double h = 0.004;
    for (int step = 0; step < 200; ++step) {
        std::vector<ChainRow> rows;
        for (Index i = 0; i < 60; i += 3) {
            const Vec3 n = Vec3(i % 2 == 0 ? 1.0 : -1.0, 0.3, 0.1).normalized();
            rows.push_back(row_at(i, n, 0.002 * std::cos(0.1 * step + i), 0.02));
            rows.back().friction = 0.3;
            rows.back().slip = Vec3(0.02, 0.0, -0.01) - n * n.dot(Vec3(0.02, 0.0, -0.01));
            rows.back().arm = Vec3(0.4, 0.1, 0.7);
        }
        rod.command(0.1, 0.01);  // a link that enters brings its momentum along, hence only now:
        const Vec3 before = momentum(rod);
        rod.predict(h);
        rod.solve(h, rows);
        rod.solve(h, rows);
        rod.finish(h);
        Vec3 force = rod.sheath_reaction_mn() + rod.drag_mn();
        double size = force.norm();
        for (const ChainRow& row : rows) {
            force += row.multiplier * row.normal + row.tangent_force;
            size += std::fabs(row.multiplier);
        }
        const Vec3 change = (momentum(rod) - before) / h;
        EXPECT_LT((change - force).norm(), 1e-6 * size) << "step " << step;
    }
}

TEST(Row, FrictionStaysInItsCone) {
    Rod rod(test::bmw(), {}, 150.0);
    const double h = 0.004;
    int pressed = 0, sliding = 0;
    for (int step = 0; step < 300; ++step) {
        std::vector<Vec3> start;
        for (std::size_t i = 0; i < 40; ++i) start.push_back(rod.link_pose(i).position);
        rod.command(step < 150 ? 0.3 : -0.3, 0.02);
        rod.predict(h);
        std::vector<ChainRow> rows;
        for (Index i = 0; i < 40; ++i) {
            const Pose pose = rod.link_pose(static_cast<std::size_t>(i));
            rows.push_back(row_at(i, Vec3::UnitY(), pose.position.y() - 0.2 * std::sin(0.5 * i), 0.05));
            rows.back().friction = 0.2;
            rows.back().arm = Vec3(0.0, -0.178, 0.0);
            rows.back().slip = pose.position - start[static_cast<std::size_t>(i)];
            rows.back().slip.y() = 0.0;
        }
        rod.solve(h, rows);
        for (const ChainRow& row : rows) {
            EXPECT_GE(row.multiplier, 0.0);
            EXPECT_NEAR(row.tangent_force.dot(row.normal), 0.0, 1e-9 * (1.0 + row.multiplier));
            EXPECT_LE(row.tangent_force.norm(), row.friction * row.multiplier * (1.0 + 1e-6) + 1e-12);
            pressed += row.multiplier > 0.0;
            sliding += row.multiplier > 0.0 && row.tangent_force.norm() > 0.98 * row.friction * row.multiplier;
        }
        rod.finish(h);
    }
    EXPECT_GT(pressed, 100);
    EXPECT_GT(sliding, 50);
}

TEST(Row, APressedWireThatSlidesFeelsTheCoulombForceAtTheSheath) {
    // Straight wire pressed sideways by p a row on a flat floor: pushing it in at a steady speed takes mu p per row.
    Rod rod(test::amplatz(), {}, 90.0);
    const double h = 0.004, weight = 20.0, mu = 0.25;
    double sheath = 0.0;
    Vec3 held = Vec3::Zero();
    for (int step = 0; step < 200; ++step) {
        rod.command(0.08, 0.0);
        const std::vector<Vec3> push(10, Vec3(0.0, -weight, 0.0));
        rod.predict(h, push);
        std::vector<ChainRow> rows;
        for (Index i = 0; i < 10; ++i) {
            rows.push_back(row_at(i, Vec3::UnitY(), 0.0, 1e-3));
            rows.back().friction = mu;
        }
        for (int k = 0; k < 2; ++k) {
            for (std::size_t i = 0; i < rows.size(); ++i) {
                rows[i].gap = rod.link_pose(i).position.y() + 1e-3 * rows[i].multiplier;
                rows[i].slip = k == 0 ? Vec3(0.0, 0.0, 0.08) : rows[i].slip;
            }
            held = rod.link_pose(0).position;
            rod.solve(h, rows);
            for (ChainRow& row : rows) row.slip += Vec3(0.0, 0.0, rod.link_pose(0).position.z() - held.z());
        }
        rod.finish(h);
        double load = 0.0, rub = 0.0;
        for (const ChainRow& row : rows) {
            load += row.multiplier;
            rub += row.tangent_force.z();
        }
        sheath = rod.sheath_force_mn();
        if (step > 150) {
            EXPECT_NEAR(load, 10.0 * weight, 0.02 * 10.0 * weight);
            EXPECT_NEAR(-rub, mu * load, 0.02 * mu * load);
        }
    }
    EXPECT_NEAR(sheath, mu * 10.0 * weight, 0.05 * mu * 10.0 * weight);
}

TEST(Row, ARowThatIsNotFiniteIsRefused) {
    Rod rod(test::bmw(), {}, 60.0);
    rod.predict(0.004);
    std::vector<ChainRow> rows{row_at(0, Vec3::UnitY(), std::nan(""), 0.01)};
    EXPECT_THROW(rod.solve(0.004, rows), std::logic_error);
    rows[0] = row_at(0, Vec3::UnitY(), 0.0, 0.0);
    EXPECT_THROW(rod.solve(0.004, rows), std::logic_error);
    rows[0] = row_at(10000, Vec3::UnitY(), 0.0, 0.01);
    EXPECT_THROW(rod.solve(0.004, rows), std::logic_error);
}

}  // namespace
}  // namespace cathlab
