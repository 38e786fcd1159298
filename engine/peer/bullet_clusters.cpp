#include "peer/bullet_clusters.h"

#include <BulletSoftBody/btSoftBody.h>

#include <new>

#include "core/check.h"

namespace cathlab {

namespace {

static_assert(sizeof(btScalar) == 8, "the program holds one Bullet, the double one");

// Bullet adds 1e-4 to each covariance, lest a flat cluster have none.  In kg mm^2 that would drown a wall's; in
// milligrams it does not, and a fit does not depend on the unit of mass.
constexpr double milligrams = 1e6;

btVector3 to_bullet(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

struct BulletClusters::Impl {
    btSoftBodyWorldInfo world;
    std::unique_ptr<btSoftBody> body;
};

BulletClusters::BulletClusters(const SoftBodyModel& model, double matching, ClusterTree tree)
    : impl_(std::make_unique<Impl>()) {
    const std::size_t n = model.size();
    std::vector<btVector3> position;
    std::vector<btScalar> mass;
    for (std::size_t i = 0; i < n; ++i) {
        position.push_back(to_bullet(model.rest[i]));
        mass.push_back(milligrams * model.mass[i]);
    }
    impl_->body = std::make_unique<btSoftBody>(&impl_->world, static_cast<int>(n), position.data(), mass.data());
    btSoftBody& body = *impl_->body;
    body.m_clusters.resize(static_cast<int>(model.cluster_count));
    for (int c = 0; c < body.m_clusters.size(); ++c) {
        // From Bullet's own allocator: its destructor gives them back to it.
        auto* cluster = new (btAlignedAlloc(sizeof(btSoftBody::Cluster), 16)) btSoftBody::Cluster();
        cluster->m_collide = tree == ClusterTree::kept;
        cluster->m_matching = matching;
        cluster->m_clusterIndex = c;
        body.m_clusters[c] = cluster;
    }
    for (std::size_t i = 0; i < n; ++i)
        for (Index m = model.cluster_start[i]; m < model.cluster_start[i + 1]; ++m) {
            const Index c = model.cluster[static_cast<std::size_t>(m)];
            body.m_clusters[c]->m_nodes.push_back(&body.m_nodes[static_cast<int>(i)]);
        }
    body.initializeClusters();
    body.updateClusters();
}

BulletClusters::~BulletClusters() = default;

std::size_t BulletClusters::cluster_count() const {
    return static_cast<std::size_t>(impl_->body->m_clusters.size());
}

std::size_t BulletClusters::membership_count() const {
    std::size_t count = 0;
    for (int c = 0; c < impl_->body->m_clusters.size(); ++c)
        count += static_cast<std::size_t>(impl_->body->m_clusters[c]->m_nodes.size());
    return count;
}

void BulletClusters::displace(std::span<const Vec3> way) {
    btSoftBody& body = *impl_->body;
    CATHLAB_CHECK(way.size() == static_cast<std::size_t>(body.m_nodes.size()), "one way a node");
    for (std::size_t i = 0; i < way.size(); ++i) body.m_nodes[static_cast<int>(i)].m_x += to_bullet(way[i]);
}

void BulletClusters::pass() {
    impl_->body->updateClusters();
}

Vec3 BulletClusters::position(std::size_t particle) const {
    const btVector3& x = impl_->body->m_nodes[static_cast<int>(particle)].m_x;
    return {x.x(), x.y(), x.z()};
}

}  // namespace cathlab
