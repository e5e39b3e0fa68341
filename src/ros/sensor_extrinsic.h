#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <tf2/buffer_core.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {

/// Pose of `sensor_frame` in `camera_frame`, by the newest transforms of `buffer`; nothing when they do not
/// connect the two.
std::optional<Eigen::Isometry3d> sensorPose(const tf2::BufferCore& buffer, const std::string& sensor_frame,
                                            const std::string& camera_frame);

/// The pose from the parameter imu_rotation, "qx qy qz qw", which leaves out where the IMU is; nothing when
/// the text is empty. Throws std::invalid_argument when it is no quaternion of a length near one.
std::optional<Eigen::Isometry3d> imuRotation(const std::string& quaternion);

/// The pose from the parameter odometry_extrinsic, "x y z qx qy qz qw" [m]; nothing when the text is empty.
/// Throws std::invalid_argument when it is no such pose.
std::optional<Eigen::Isometry3d> odometryExtrinsic(const std::string& pose);

/// The pose of a sensor in the camera's frame as it becomes known: from a parameter, or from tf once its
/// frames connect. Thread-safe.
class SensorExtrinsic {
 public:
  /// `sensor`, `parameter`: their names, for the warning.
  SensorExtrinsic(std::string sensor, std::string parameter);

  /// Images that wait for tf; after them its lack is warned of, and tf is only asked.
  static constexpr int kPatienceImages = 20;

  /// As the parameter says; nothing: tf decides.
  void set(const std::optional<Eigen::Isometry3d>& pose);
  std::optional<Eigen::Isometry3d> pose() const;
  /// Whether it is worth while to wait for messages of the sensor.
  bool isHopeful() const;

  /// Looks for the pose if there is none, and waits for it at most `patience_s` and until `is_crowded`.
  /// Gives a sentence when it is time to warn that there is none. Call once per image.
  std::optional<std::string> find(
      const tf2::BufferCore& buffer, const std::string& sensor_frame, const std::string& camera_frame,
      double patience_s, const std::function<bool()>& is_crowded = [] { return false; });

 private:
  const std::string sensor_, parameter_;
  mutable std::mutex mutex_;  ///< guards everything below
  std::optional<Eigen::Isometry3d> pose_;
  int images_without_{0};
};

}  // namespace tet_line_tracker
