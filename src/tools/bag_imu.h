#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <rosbag/bag.h>
#include <Eigen/Core>

#include "../ros/angular_velocity_queue.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {

/// An IMU topic of a bag, read whole and handed out image by image.
class BagImu {
 public:
  BagImu(const rosbag::Bag& bag, std::string topic);

  /// Gives `tracker` the rotation from the IMU's frame to `camera_frame`: `given` if there is one, else by
  /// /tf_static and /tf of the bag. When neither tells it: a warning.
  void setRotation(const std::string& camera_frame, const std::optional<Eigen::Matrix3d>& given,
                   LineTracker& tracker) const;

  /// Gives `tracker` what it has not had yet up to the stamp of an image and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker) { samples_.feed(stamp_ns, tracker); }

 private:
  const rosbag::Bag& bag_;
  std::string topic_, frame_;
  AngularVelocityQueue samples_;
};

}  // namespace tet_line_tracker
