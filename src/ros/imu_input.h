#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>
#include <Eigen/Core>

#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {

/// Rotation that takes directions in `imu_frame` to `camera_frame`, by the newest transforms of `frames`;
/// nothing when they do not connect the two.
std::optional<Eigen::Matrix3d> imuRotation(const tf2::BufferCore& frames, const std::string& imu_frame,
                                           const std::string& camera_frame);

/// The same from a parameter "qx qy qz qw"; nothing when the text is empty. Throws std::invalid_argument when
/// it is no quaternion of a length near one.
std::optional<Eigen::Matrix3d> imuRotation(const std::string& quaternion);

/// Holds the messages of an IMU until the image that needs them: each image gets those up to its stamp and
/// one after it, whenever they came. Thread-safe.
class ImuInput {
 public:
  void add(const sensor_msgs::Imu& message);

  /// Waits until a message at or after the stamp of an image has come, at most `patience_s`, and not at all
  /// when the IMU has been silent since it was last waited for in vain. False when there is none.
  bool waitFor(std::int64_t stamp_ns, double patience_s);

  /// Gives `tracker` what it has not had yet up to the stamp of an image and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker);

  /// Of the messages; nothing before the first.
  std::optional<std::string> frame() const;

 private:
  struct Sample {
    std::int64_t stamp_ns;
    Eigen::Vector3d angular_velocity;
  };
  /// Messages between two jumps of the stamps, as of a bag that is played in a loop.
  using Stretch = std::deque<Sample>;

  void leaveOldStretches(std::int64_t stamp_ns);
  void leaveStretch();
  bool covers(std::int64_t stamp_ns) const;

  mutable std::mutex mutex_;  ///< guards everything below
  std::condition_variable arrived_;
  std::deque<Stretch> stretches_;   ///< oldest first; each but the last is complete
  std::optional<Sample> last_fed_;  ///< of the first stretch
  std::optional<std::string> frame_;
  bool silent_{false};  ///< since a wait in vain
};

}  // namespace tet_line_tracker
