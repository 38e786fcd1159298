// The few vector types that every room shares. Eigen is the one package whose types may cross a room's door.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace cathlab {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Index = std::int32_t;
using Triangle = Eigen::Matrix<Index, 3, 1>;

/// A frame: p_world = position + orientation * p_local.  Lengths in mm.
struct Pose {
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();

    Vec3 to_world(const Vec3& p_local) const { return position + orientation * p_local; }
    Vec3 to_local(const Vec3& p_world) const { return orientation.conjugate() * (p_world - position); }
};

}  // namespace cathlab
