// Bullet's side of the wire: one rigid capsule a link, one joint between neighbours, in a discrete dynamics world in
// double precision.  Bullet holds transforms, velocities, masses and inertias; the joints are solved by chain_solve.h
// and not by Bullet's sequential impulses, which open by more than a link at a wire's stiffness.  Only this room
// includes this file.
#pragma once

#include <memory>

#include "core/types.h"
#include "rod/wire_links.h"

namespace cathlab {

/// Where a body is and how it moves; the body's z axis is the capsule's axis and points to the wire's tip.
struct BodyMotion {
    Pose pose;
    Vec3 velocity = Vec3::Zero();  ///< of the centre, mm/s, world
    Vec3 spin = Vec3::Zero();      ///< angular velocity, rad/s, world
};

class BulletWorld {
public:
    BulletWorld();
    ~BulletWorld();
    BulletWorld(const BulletWorld&) = delete;
    BulletWorld& operator=(const BulletWorld&) = delete;

    std::size_t size() const;
    /// Adds a capsule behind the last one and joins it to that.
    void add(const WireLink& link, const BodyMotion& motion);
    /// Takes the last capsule and its joint out of the world.
    void remove_last();
    BodyMotion motion(std::size_t i) const;
    void set_motion(std::size_t i, const BodyMotion& motion);
    /// Held links are Bullet's kinematic objects: they go where the sheath puts them.
    void set_held(std::size_t i, bool held);
    /// The joint behind link i; i + 1 < size().
    void set_joint(std::size_t i, const JointStiffness& stiffness);
    const JointStiffness& joint(std::size_t i) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
