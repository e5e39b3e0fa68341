#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "counter_random.h"
#include "trajectory.h"

namespace tet_line_tracker {

struct InertialSample {
  Eigen::Vector3d angular_velocity;  ///< in the IMU's frame [rad/s]
  Eigen::Vector3d acceleration;      ///< specific force in the IMU's frame [m/s^2]
};

constexpr double kGravity = 9.81;  ///< along -z of the world [m/s^2]

/// What an ideal IMU, fixed to the camera, measures at a time of the trajectory.
InertialSample idealInertialSample(const Trajectory& trajectory, const Eigen::Isometry3d& camera_from_imu,
                                   double time_s);

/// Noise and drifting bias of a MEMS unit as EuRoC's (ADIS16448).
class InertialErrors {
 public:
  InertialErrors(std::uint64_t seed, double rate_hz);

  /// The next sample in time with its errors.
  InertialSample apply(const InertialSample& ideal);

 private:
  Eigen::Vector3d normal();

  RandomSequence random_;
  double rate_hz_;
  Eigen::Vector3d gyro_bias_, accelerometer_bias_;
};

}  // namespace tet_line_tracker
