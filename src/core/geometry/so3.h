#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tet_line_tracker {

/// Exponential map of SO(3): the rotation of a rotation vector, which is axis times angle [rad]. As angle and
/// axis, which convert to a matrix and to a quaternion.
inline Eigen::AngleAxisd so3Exp(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) return Eigen::AngleAxisd(0.0, Eigen::Vector3d::UnitX());
  return Eigen::AngleAxisd(angle, rotation_vector / angle);
}

/// Logarithm of SO(3), the inverse of so3Exp(): the rotation vector of a rotation matrix, of length 0..pi.
inline Eigen::Vector3d so3Log(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

}  // namespace tet_line_tracker
