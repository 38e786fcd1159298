// The peer does the same work as our wall: the same clusters, and a pass that draws a body back to its shape.
#include "peer/bullet_clusters.h"

#include <gtest/gtest.h>

#include "core/deterministic_math.h"
#include "core/random.h"
#include "softbody/tube.h"

namespace cathlab {
namespace {

constexpr std::size_t particles = 500;
constexpr double spacing_mm = 2.1;

SoftBodyModel tube() {
    return build_soft_body(tube_sample(tube_for(particles, spacing_mm), spacing_mm, 1.0, 3), {}, nullptr);
}

double rms(const BulletClusters& peer, const std::vector<Vec3>& wanted) {
    double sum = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) sum += (peer.position(i) - wanted[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(wanted.size()));
}

}  // namespace

TEST(BulletClusters, AreTheWallsOwn) {
    const SoftBodyModel model = tube();
    const BulletClusters peer(model, 1.0, ClusterTree::none);
    EXPECT_EQ(peer.cluster_count(), model.cluster_count);
    EXPECT_EQ(peer.membership_count(), model.membership_count());
    EXPECT_LT(rms(peer, model.rest), 1e-7);
}

TEST(BulletClusters, ATurnedBodyStaysWhereItIs) {
    const SoftBodyModel model = tube();
    BulletClusters peer(model, 1.0, ClusterTree::none);
    const double c = det::cos(0.7), s = det::sin(0.7);
    std::vector<Vec3> turned, way;
    for (const Vec3& x : model.rest) {
        turned.emplace_back(c * x.x() - s * x.y() + 3.0, s * x.x() + c * x.y() - 1.0, x.z() + 5.0);
        way.push_back(turned.back() - x);
    }
    peer.displace(way);
    peer.pass();
    EXPECT_LT(rms(peer, turned), 1e-4);
}

TEST(BulletClusters, PassesTakeDisorderBackToTheShape) {
    const SoftBodyModel model = tube();
    BulletClusters peer(model, 0.8, ClusterTree::kept);
    std::vector<Vec3> way;
    for (std::size_t i = 0; i < model.size(); ++i) {
        Vec3& w = way.emplace_back();
        for (int k = 0; k < 3; ++k)
            w[k] = random_uniform(1, RandomStream::test, static_cast<std::uint64_t>(k), i) - 0.5;
    }
    peer.displace(way);
    const double before = rms(peer, model.rest);
    for (int k = 0; k < 4; ++k) peer.pass();
    EXPECT_LT(rms(peer, model.rest), 0.5 * before);
}

}  // namespace cathlab
