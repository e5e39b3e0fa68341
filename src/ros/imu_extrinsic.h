#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <tf2/buffer_core.h>
#include <Eigen/Core>

namespace tet_line_tracker {

/// Rotation that takes directions in `imu_frame` to `camera_frame`, by the newest transforms of `buffer`;
/// nothing when they do not connect the two.
std::optional<Eigen::Matrix3d> imuRotation(const tf2::BufferCore& buffer, const std::string& imu_frame,
                                           const std::string& camera_frame);

/// The same from a parameter "qx qy qz qw"; nothing when the text is empty. Throws std::invalid_argument when
/// it is no quaternion of a length near one.
std::optional<Eigen::Matrix3d> imuRotation(const std::string& quaternion);

/// The rotation between IMU and camera as it becomes known: from a parameter, or from tf once its frames
/// connect. Thread-safe.
class ImuExtrinsic {
 public:
  /// Images that wait for tf; after them its lack is warned of, and tf is only asked.
  static constexpr int kPatienceImages = 20;

  /// As the parameter says; nothing: tf decides.
  void set(const std::optional<Eigen::Matrix3d>& rotation);
  std::optional<Eigen::Matrix3d> rotation() const;
  /// Whether it is worth while to wait for messages of the IMU.
  bool isHopeful() const;

  /// Looks for the rotation if there is none, and waits for it at most `patience_s` and until `is_crowded`.
  /// Gives a sentence when it is time to warn that there is none. Call once per image.
  std::optional<std::string> find(
      const tf2::BufferCore& buffer, const std::string& imu_frame, const std::string& camera_frame,
      double patience_s, const std::function<bool()>& is_crowded = [] { return false; });

 private:
  mutable std::mutex mutex_;  ///< guards everything below
  std::optional<Eigen::Matrix3d> rotation_;
  int images_without_{0};
};

}  // namespace tet_line_tracker
