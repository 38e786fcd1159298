#include "rod/bullet_world.h"

#include <btBulletDynamicsCommon.h>

#include "core/check.h"

namespace cathlab {
namespace {

static_assert(sizeof(btScalar) == 8, "the wire needs Bullet in double precision");

btVector3 to_bullet(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}
Vec3 from_bullet(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}

// From components alone: Bullet's constructor from axis and angle would call the C library's sin and cos.
btTransform to_bullet(const Pose& pose) {
    const Quat& q = pose.orientation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(pose.position));
}

Pose from_bullet(const btTransform& transform) {
    const btQuaternion q = transform.getRotation();
    return {from_bullet(transform.getOrigin()), Quat(q.w(), q.x(), q.y(), q.z())};
}

// Joins the rear end of A to the front end of B.  It asks Bullet's iterative solver for no rows: the chain is solved
// whole.
class RodJoint final : public btTypedConstraint {
public:
    RodJoint(btRigidBody& a, btRigidBody& b) : btTypedConstraint(FIXED_CONSTRAINT_TYPE, a, b) {}

    void getInfo1(btConstraintInfo1* info) override {
        info->m_numConstraintRows = 0;
        info->nub = 0;
    }
    void getInfo2(btConstraintInfo2* /*info*/) override {}
    void setParam(int /*parameter*/, btScalar /*value*/, int /*axis*/) override {}
    btScalar getParam(int /*parameter*/, int /*axis*/) const override { return 0.0; }

    JointStiffness stiffness;
};

}  // namespace

struct BulletWorld::Impl {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCapsuleShapeZ>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    std::vector<std::unique_ptr<RodJoint>> joints;
};

BulletWorld::BulletWorld() : impl_(std::make_unique<Impl>()) {
    impl_->world.setGravity(btVector3(0, 0, 0));
}

BulletWorld::~BulletWorld() {
    while (size() > 0) remove_last();
}

std::size_t BulletWorld::size() const {
    return impl_->bodies.size();
}

void BulletWorld::add(const WireLink& link, const BodyMotion& motion) {
    auto shape = std::make_unique<btCapsuleShapeZ>(link.radius, link.length);
    const btVector3 inertia(link.inertia_across, link.inertia_across, link.inertia_along);
    auto body = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(link.mass, nullptr, shape.get(), inertia));
    body->setActivationState(DISABLE_DEACTIVATION);
    impl_->world.addRigidBody(body.get(), 0, 0);  // collides with nothing here: the wall is not Bullet's
    if (!impl_->bodies.empty()) {
        impl_->joints.push_back(std::make_unique<RodJoint>(*impl_->bodies.back(), *body));
        impl_->world.addConstraint(impl_->joints.back().get(), true);
    }
    impl_->shapes.push_back(std::move(shape));
    impl_->bodies.push_back(std::move(body));
    set_motion(size() - 1, motion);
}

void BulletWorld::remove_last() {
    CATHLAB_CHECK(size() > 0, "the chain has no link left");
    if (!impl_->joints.empty()) {
        impl_->world.removeConstraint(impl_->joints.back().get());
        impl_->joints.pop_back();
    }
    impl_->world.removeRigidBody(impl_->bodies.back().get());
    impl_->bodies.pop_back();
    impl_->shapes.pop_back();
}

BodyMotion BulletWorld::motion(std::size_t i) const {
    const btRigidBody& body = *impl_->bodies[i];
    return {from_bullet(body.getWorldTransform()), from_bullet(body.getLinearVelocity()),
            from_bullet(body.getAngularVelocity())};
}

void BulletWorld::set_motion(std::size_t i, const BodyMotion& motion) {
    btRigidBody& body = *impl_->bodies[i];
    const btTransform transform = to_bullet(motion.pose);
    body.setWorldTransform(transform);
    body.setInterpolationWorldTransform(transform);
    body.setLinearVelocity(to_bullet(motion.velocity));
    body.setAngularVelocity(to_bullet(motion.spin));
}

void BulletWorld::set_held(std::size_t i, bool held) {
    btRigidBody& body = *impl_->bodies[i];
    const int flag = btCollisionObject::CF_KINEMATIC_OBJECT;
    body.setCollisionFlags(held ? body.getCollisionFlags() | flag : body.getCollisionFlags() & ~flag);
}

void BulletWorld::set_joint(std::size_t i, const JointStiffness& stiffness) {
    impl_->joints[i]->stiffness = stiffness;
}

const JointStiffness& BulletWorld::joint(std::size_t i) const {
    return impl_->joints[i]->stiffness;
}

}  // namespace cathlab
