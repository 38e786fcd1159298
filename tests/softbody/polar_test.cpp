// The rotation of a cluster: the kernel's iteration against a singular value decomposition.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/random.h"
#include "rig.h"
#include "softbody/kernel.h"

namespace cathlab {
namespace {

constexpr int lanes = static_cast<int>(kernel::lanes);

struct Batch {
    std::array<double, 9 * kernel::lanes> matrix{};
    std::array<double, 4 * kernel::lanes> quaternion{};

    Batch() {
        for (int l = 0; l < lanes; ++l) quaternion[static_cast<std::size_t>(l)] = 1.0;
    }
    /// Of the k-th number of a lane.
    static std::size_t at(int k, int lane) {
        return static_cast<std::size_t>(k) * kernel::lanes + static_cast<std::size_t>(lane);
    }
    void set(int lane, const Mat3& a) {
        for (int k = 0; k < 9; ++k) matrix[at(k, lane)] = a(k / 3, k % 3);
    }
    Mat3 rotation(int lane) const {
        const auto q = [&](int k) { return quaternion[at(k, lane)]; };
        return Quat(q(0), q(1), q(2), q(3)).toRotationMatrix();
    }
};

std::array<std::uint64_t, 4 * kernel::lanes> bits(const Batch& batch) {
    return std::bit_cast<std::array<std::uint64_t, 4 * kernel::lanes>>(batch.quaternion);
}

Mat3 random_matrix(std::uint64_t index) {
    Mat3 a;
    for (int k = 0; k < 9; ++k)
        a(k / 3, k % 3) = random_normal(3, RandomStream::test, static_cast<std::uint64_t>(k), index);
    return a;
}

/// The rotation with the largest trace(R^T A), and how well it is determined: the least sum of two (signed) singular
/// values over the largest.
Mat3 by_svd(const Mat3& a, double& margin) {
    const Eigen::JacobiSVD<Mat3> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    margin = (svd.singularValues()[1] + sign * svd.singularValues()[2]) / svd.singularValues()[0];
    return svd.matrixU() * Vec3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Iterates from no rotation, as substeps would.
void solve(kernel::Polar polar, Batch& batch, int calls) {
    for (int k = 0; k < calls; ++k) polar(batch.matrix.data(), batch.quaternion.data());
}

double worst_error(kernel::Polar polar, int batches, double least_margin, bool inverted) {
    double worst = 0.0;
    for (int b = 0; b < batches; ++b) {
        Batch batch;
        std::array<Mat3, lanes> matrices;
        for (int l = 0; l < lanes; ++l) {
            Mat3 a = random_matrix(Batch::at(b, l));
            if ((a.determinant() < 0.0) != inverted) a.row(0) *= -1.0;
            matrices[static_cast<std::size_t>(l)] = a;
            batch.set(l, a);
        }
        solve(polar, batch, 12);
        for (int l = 0; l < lanes; ++l) {
            double margin = 0.0;
            const Mat3 expected = by_svd(matrices[static_cast<std::size_t>(l)], margin);
            if (margin < least_margin) continue;
            worst = std::max(worst, (batch.rotation(l) - expected).norm());
        }
    }
    return worst;
}

TEST(Polar, RandomMatricesGiveTheRotationOfTheirSingularVectors) {
    EXPECT_LT(worst_error(kernel::best().polar_double, 4000, 0.02, false), 1e-10);
    EXPECT_LT(worst_error(kernel::best().polar_float, 4000, 0.02, false), 2e-3);
    EXPECT_LT(worst_error(kernel::best().polar_float, 4000, 0.3, false), 2e-5);
}

TEST(Polar, InvertedMatricesGiveTheNearestProperRotation) {
    EXPECT_LT(worst_error(kernel::best().polar_double, 4000, 0.05, true), 1e-9);
}

TEST(Polar, AWarmStartFollowsATurningBodyExactly) {
    Batch batch;
    for (int step = 1; step <= 200; ++step) {
        std::array<Mat3, lanes> turns;
        for (int l = 0; l < lanes; ++l) {
            const Mat3 turn = det::rotation_from_vector(0.05 * step * Vec3(1, 0.1 * l, -0.4)).toRotationMatrix();
            turns[static_cast<std::size_t>(l)] = turn;
            batch.set(l, turn * Vec3(40, 30, 2.0 + l).asDiagonal());
        }
        solve(kernel::best().polar_double, batch, 1);
        for (int l = 0; l < lanes; ++l)
            ASSERT_LT((batch.rotation(l) - turns[static_cast<std::size_t>(l)]).norm(), 1e-12) << step;
    }
}

TEST(Polar, DegenerateMatricesStayFiniteAndGiveARotation) {
    const Vec3 u(0.3, -0.5, 0.8), w(0.9, 0.1, -0.2);
    const std::array<Mat3, lanes> hard{Mat3::Zero(),
                                       Mat3(u * w.transpose()),                      // a line
                                       Mat3(u * w.transpose() + w * u.transpose()),  // a plane
                                       Mat3(-Mat3::Identity()),                      // turned inside out
                                       Mat3(Vec3(1, 1, -1).asDiagonal()),            // mirrored
                                       Mat3(Vec3(-1, -1, 1).asDiagonal()),           // half a turn away: a saddle
                                       Mat3(1e-30 * random_matrix(1)),
                                       Mat3(1e30 * random_matrix(2))};
    for (const kernel::Polar polar : {kernel::best().polar_double, kernel::best().polar_float}) {
        Batch batch;
        for (int l = 0; l < lanes; ++l) batch.set(l, hard[static_cast<std::size_t>(l)]);
        solve(polar, batch, 5);
        for (int l = 0; l < lanes; ++l) {
            const Mat3 r = batch.rotation(l);
            ASSERT_TRUE(r.allFinite()) << l;
            ASSERT_LT((r * r.transpose() - Mat3::Identity()).norm(), 1e-5) << l;
        }
    }
}

TEST(Polar, EveryInstructionSetGivesTheSameBits) {
    const kernel::Set* wide = kernel::avx2();
    if (!wide) GTEST_SKIP() << "this processor has no AVX2";
    for (int b = 0; b < 500; ++b) {
        Batch one, two;
        for (int l = 0; l < lanes; ++l) {
            const Mat3 a = random_matrix(Batch::at(b, l)) * (l == 3 ? 0.0 : 1.0);
            one.set(l, a);
            two.set(l, a);
        }
        kernel::baseline().polar_double(one.matrix.data(), one.quaternion.data());
        wide->polar_double(two.matrix.data(), two.quaternion.data());
        ASSERT_EQ(bits(one), bits(two));
        kernel::baseline().polar_float(one.matrix.data(), one.quaternion.data());
        wide->polar_float(two.matrix.data(), two.quaternion.data());
        ASSERT_EQ(bits(one), bits(two));
    }
}

/// A whole fit and gather by both instruction sets.
void compare_sets(Precision precision) {
    WallParameters parameters;
    parameters.precision = precision;
    rig::Wall wall(rig::free_tube(parameters));
    rig::shake(wall, 100.0);
    wall.step(0.004, 2);
    const auto run = [&](const kernel::Set& set, std::vector<double>& goal) {
        std::vector<double> rotation = wall.state.rotation;
        const std::size_t numbers = (wall.model.empty_lane() + 1) * kernel::transform_numbers;
        AlignedVector<double> transform(numbers);
        AlignedVector<std::int32_t> grid(3 * wall.model.size() + 1), grid_transform(numbers);
        std::vector<std::uint8_t> far(wall.model.group_count());
        const kernel::Groups<double> view = wall.model.clusters.view();
        const kernel::Groups<float> view_float = wall.model.clusters_float.view();
        const double* x = wall.state.x.front().data();
        const double* rest = wall.model.rest.front().data();
        const kernel::Goals goals = wall.model.goals.view();
        const std::size_t groups = wall.model.group_count();
        goal.resize(3 * wall.model.size());
        if (precision == Precision::double_) {
            set.fit_double(&view, {x, nullptr}, rotation.data(), transform.data(), nullptr, 0, groups);
            set.gather_double(goals, transform.data(), rest, x, goal.data(), 0, wall.model.size());
        } else {
            set.to_grid(x, grid.data(), 0, 3 * wall.model.size());
            set.fit_float(&view_float, {x, grid.data()}, rotation.data(), grid_transform.data(), far.data(), 0, groups);
            set.gather_float(goals, grid_transform.data(), rest, x, goal.data(), 0, wall.model.size());
        }
    };
    std::vector<double> one, two;
    run(kernel::baseline(), one);
    run(*kernel::avx2(), two);
    EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(double)), 0);
}

TEST(Kernel, FitsAndGoalsHaveTheSameBitsOnEveryInstructionSet) {
    if (!kernel::avx2()) GTEST_SKIP() << "this processor has no AVX2";
    compare_sets(Precision::double_);
    compare_sets(Precision::float_);
}

}  // namespace
}  // namespace cathlab
