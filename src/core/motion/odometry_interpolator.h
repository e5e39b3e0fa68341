#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "motion/stamped_samples.h"

namespace tet_line_tracker {

/// Motion of a body between two stamps from the poses of an odometry, interpolated at both ends.
class OdometryInterpolator {
 public:
  /// Pose of the body in the odometry's frame [m]. Poses that are not newer than the last one or not finite
  /// are ignored; a jump of the stamps back by more than kMaxGapNs starts anew (a bag played in a loop).
  void add(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body);

  /// Takes points in the body's frame at `from_ns` to the same points at `to_ns`; nothing when the poses do
  /// not cover the interval, have a gap of more than kMaxGapNs in it, or jump: faster than kMaxSpeed.
  std::optional<Eigen::Isometry3d> motion(std::int64_t from_ns, std::int64_t to_ns) const;

  /// Forgets poses that are not needed from `stamp_ns` on.
  void forgetBefore(std::int64_t stamp_ns) { samples_.forgetBefore(stamp_ns); }

  static constexpr std::int64_t kMaxGapNs = 500000000;
  /// Whatever is faster was moved by hand: a corrected or restarted estimate [m/s].
  static constexpr double kMaxSpeed = 200.0;

 private:
  struct Sample {
    std::int64_t stamp_ns;
    Eigen::Quaterniond rotation;
    Eigen::Vector3d translation;
  };
  /// Nothing where the poses do not cover the stamp.
  std::optional<Eigen::Isometry3d> poseAt(std::int64_t stamp_ns) const;

  StampedSamples<Sample> samples_;
};

}  // namespace tet_line_tracker
