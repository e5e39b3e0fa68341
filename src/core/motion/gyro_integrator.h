#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "motion/stamped_samples.h"

namespace tet_line_tracker {

/// Integrates the angular velocities of a gyroscope between two stamps, interpolated at both ends.
class GyroIntegrator {
 public:
  /// Angular velocity in the IMU's frame [rad/s]. Samples that are not newer than the last one, not
  /// finite or faster than kMaxAngularVelocity are ignored; a jump back of more than kMaxGapNs starts anew (a
  /// bag played in a loop).
  void add(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity);

  /// Rotation that takes directions in the IMU's frame at `from_ns` to the same directions at `to_ns`;
  /// nothing when the samples do not cover the interval or have a gap of more than kMaxGapNs.
  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns,
                                          const Eigen::Vector3d& bias) const;

  /// Forgets samples that end before `stamp_ns`.
  void forgetBefore(std::int64_t stamp_ns) { samples_.forgetBefore(stamp_ns); }

  static constexpr std::int64_t kMaxGapNs = 100000000;
  /// No camera turns at 160 revolutions per second, and no gyroscope measures it [rad/s].
  static constexpr double kMaxAngularVelocity = 1000.0;

 private:
  struct Sample {
    std::int64_t stamp_ns;
    Eigen::Vector3d angular_velocity;
  };
  StampedSamples<Sample> samples_;
};

}  // namespace tet_line_tracker
