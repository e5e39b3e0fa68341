#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "counter_random.h"
#include "trajectory.h"

namespace tet_line_tracker {

/// Pose of base_link (x forward, y left, z up) in the camera: of a car, on its rear axle; of whatever flies,
/// near the camera.
Eigen::Isometry3d defaultCameraFromBody(bool car);

/// Dead reckoning of base_link along a trajectory, with a wrong scale, a drift of the heading and noise. A
/// car's knows its way forward and its heading only: no pitch, no roll, no slip.
class SimulatedOdometry {
 public:
  SimulatedOdometry(const Trajectory& trajectory, bool car, std::uint64_t seed, double start_s);

  /// Goes on to a later time of the trajectory [s]; gives the pose in the odometry's frame [m].
  const Eigen::Isometry3d& advance(double time_s);

 private:
  const Trajectory& trajectory_;
  const bool car_;
  const Eigen::Isometry3d camera_from_body_;
  RandomSequence random_;
  double scale_, drift_;  ///< of the way; of the heading [rad/s]
  double time_s_;
  Eigen::Isometry3d pose_{Eigen::Isometry3d::Identity()};
};

}  // namespace tet_line_tracker
