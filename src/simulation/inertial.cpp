#include "inertial.h"

#include <cmath>

namespace tet_line_tracker {
namespace {

constexpr double kGyroNoise = 1.7e-4;              // [rad/s/sqrt(Hz)]
constexpr double kGyroBiasWalk = 1.9e-5;           // [rad/s^2/sqrt(Hz)]
constexpr double kGyroBias = 0.02;                 // deviation at the start [rad/s]
constexpr double kAccelerometerNoise = 2.0e-3;     // [m/s^2/sqrt(Hz)]
constexpr double kAccelerometerBiasWalk = 3.0e-3;  // [m/s^3/sqrt(Hz)]
constexpr double kAccelerometerBias = 0.1;         // deviation at the start [m/s^2]

}  // namespace

InertialSample idealInertialSample(const Trajectory& trajectory, const Eigen::Isometry3d& camera_from_imu,
                                   double time_s) {
  const auto pose = [&](double t) { return trajectory.worldFromCamera(t) * camera_from_imu; };
  // Central differences of an analytic function: their error is far below the sensor's resolution.
  constexpr double kStep = 5e-4;
  const Eigen::Isometry3d before = pose(time_s - kStep);
  const Eigen::Isometry3d now = pose(time_s);
  const Eigen::Isometry3d after = pose(time_s + kStep);
  const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
  const Eigen::Vector3d acceleration =
      (after.translation() - 2.0 * now.translation() + before.translation()) / (kStep * kStep);
  InertialSample sample;
  sample.angular_velocity = turn.axis() * (turn.angle() / (2.0 * kStep));
  sample.acceleration = now.linear().transpose() * (acceleration + Eigen::Vector3d(0.0, 0.0, kGravity));
  return sample;
}

InertialErrors::InertialErrors(std::uint64_t seed, double rate_hz)
    : random_(seed, 4),
      rate_hz_(rate_hz),
      gyro_bias_(kGyroBias * normal()),
      accelerometer_bias_(kAccelerometerBias * normal()) {}

Eigen::Vector3d InertialErrors::normal() {
  const double x = random_.normal();
  const double y = random_.normal();
  return {x, y, random_.normal()};
}

InertialSample InertialErrors::apply(const InertialSample& ideal) {
  InertialSample sample = ideal;
  const double noise_scale = std::sqrt(rate_hz_);
  sample.angular_velocity += gyro_bias_ + kGyroNoise * noise_scale * normal();
  sample.acceleration += accelerometer_bias_ + kAccelerometerNoise * noise_scale * normal();
  gyro_bias_ += kGyroBiasWalk / noise_scale * normal();
  accelerometer_bias_ += kAccelerometerBiasWalk / noise_scale * normal();
  return sample;
}

}  // namespace tet_line_tracker
