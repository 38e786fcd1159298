// Bullet's shape matching over the clusters of one of our walls: what our own solver is measured against.  Nothing of
// the simulator is computed here.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/types.h"
#include "softbody/model.h"

namespace cathlab {

/// What a pass does beside matching shapes: generateClusters leaves Bullet's clusters in a tree of boxes, moved with
/// each pass, in which collisions between clusters are looked for.
enum class ClusterTree { none, kept };

/// A btSoftBody (double precision) whose nodes are the wall's particles and whose clusters are the wall's clusters, set
/// up by hand as btSoftBody::generateClusters would have left them.  Its nodes have the particles' masses, and none is
/// fixed.
class BulletClusters {
public:
    /// matching: the share, in [0, 1], by which each cluster in turn draws its nodes to their goals.
    BulletClusters(const SoftBodyModel& model, double matching, ClusterTree tree);
    ~BulletClusters();
    BulletClusters(const BulletClusters&) = delete;
    BulletClusters& operator=(const BulletClusters&) = delete;

    std::size_t cluster_count() const;
    std::size_t membership_count() const;

    /// Moves every node by so much, mm (n).
    void displace(std::span<const Vec3> way);
    /// One pass over the clusters, one after another: centroid, covariance, polar decomposition, velocities of the
    /// frame, and the nodes drawn towards their goals; then the tree, where it is kept.
    void pass();

    Vec3 position(std::size_t particle) const;  ///< mm

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
