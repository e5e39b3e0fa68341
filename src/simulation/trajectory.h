#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "road_curve.h"

namespace tet_line_tracker {

struct TrajectoryOptions {
  std::string motion{"slow"};  ///< slow, fast, corridor, shake, rotation, still, drive
  double seconds{20.0};        ///< of the sequence [s]
  std::uint64_t seed{1};       ///< phases of the waves, and the street's bends
  bool hand_sway{false};       ///< and to and fro as in a hand, with accelerations of about 1 m/s^2

  Eigen::Vector3d free_centre;       ///< box in which the camera may move, in the world [m]
  Eigen::Vector3d free_half_extent;  ///< [m]

  /// Look at a bare wall from here for kBareWallHold in the middle of the sequence [m, rad].
  struct BareWallView {
    Eigen::Vector3d position;
    double yaw;
  };
  std::optional<BareWallView> bare_wall_view;
};

/// A camera's motion with continuous acceleration: sums of sines in position and in yaw, pitch and roll, so
/// that an IMU on it is exact. Defined for all times; 0 is the first image.
class Trajectory {
 public:
  /// Throws std::invalid_argument for an unknown motion.
  explicit Trajectory(const TrajectoryOptions& options);

  /// Pose of the optical frame (x right, y down, z forward) in the world (z up).
  Eigen::Isometry3d worldFromCamera(double time_s) const;

  static constexpr double kBareWallHold = 1.5;  ///< [s]
  static constexpr double kBareWallTurn = 1.5;  ///< time to get there, and back [s]
  static constexpr double kFlightSpeed = 1.1;   ///< of motion corridor [m/s]
  static constexpr double kFlightStart = 3.0;   ///< x at time 0 of motion corridor [m]
  static constexpr double kDriveSpeed = 9.5;    ///< along x, mean of motion drive [m/s]

 private:
  enum Channel { kX, kY, kZ, kYaw, kPitch, kRoll, kChannels };
  struct Wave {
    double amplitude, frequency_hz, phase;
  };
  struct Signal {
    double offset{0.0};
    double slope{0.0};
    std::vector<Wave> waves;
    double at(double time_s) const;
  };

  double bareWallWeight(double time_s) const;

  std::array<Signal, kChannels> signals_;
  std::optional<RoadCurve> road_;  ///< y and yaw are relative to it
  std::optional<TrajectoryOptions::BareWallView> bare_wall_view_;
  double middle_s_;
};

}  // namespace tet_line_tracker
