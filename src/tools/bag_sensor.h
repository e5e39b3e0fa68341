#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <Eigen/Geometry>

#include "../ros/motion_samples.h"
#include "../ros/sample_queue.h"

namespace tet_line_tracker {

/// A topic of a bag that tells how the camera moves, read whole and handed out image by image. `Message`:
/// sensor_msgs::Imu or nav_msgs::Odometry.
template <class Message>
class BagSensor {
 public:
  BagSensor(const rosbag::Bag& bag, std::string topic);

  /// Pose of the sensor in `camera_frame`: `given` if there is one, else by /tf_static and /tf of the bag.
  /// When neither tells it: nothing, and a warning that names the `parameter`.
  std::optional<Eigen::Isometry3d> findPose(const std::string& camera_frame,
                                            const std::optional<Eigen::Isometry3d>& given,
                                            const char* parameter) const;

  /// Gives `tracker` what it has not had yet up to the stamp of an image and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker) { samples_.feed(stamp_ns, tracker); }

 private:
  using Sample = decltype(toSample(std::declval<Message>()));

  const rosbag::Bag& bag_;
  std::string topic_, frame_;
  SampleQueue<Sample> samples_;
};

}  // namespace tet_line_tracker
