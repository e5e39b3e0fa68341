#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <sensor_msgs/Imu.h>
#include <Eigen/Core>

#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {

struct AngularVelocity {
  std::int64_t stamp_ns;
  Eigen::Vector3d rad_per_s;  ///< in the IMU's frame
};

AngularVelocity toAngularVelocity(const sensor_msgs::Imu& message);

/// Angular velocities by ascending stamps until an image needs them: each image gets those up to its stamp
/// and one after it. The node and track_bag both feed their tracker from here.
class AngularVelocityQueue {
 public:
  /// A sample without a stamp (0) is ignored, and one that is not newer than the last.
  void add(const AngularVelocity& sample);
  /// Forgets the oldest samples until at most `size` wait.
  void keepNewest(std::size_t size);

  /// Gives `tracker` what it has not had yet of the samples up to the stamp of an image, and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker);

  /// Whether there is a sample at or after `stamp_ns`, given to the tracker or not.
  bool covers(std::int64_t stamp_ns) const;
  /// Stamps of the last sample that the tracker got, or else of the first that waits, and of the newest one
  /// [ns].
  std::optional<std::int64_t> oldest() const;
  std::optional<std::int64_t> newest() const;

 private:
  std::deque<AngularVelocity> waiting_;
  std::optional<std::int64_t> last_fed_ns_;
};

}  // namespace tet_line_tracker
