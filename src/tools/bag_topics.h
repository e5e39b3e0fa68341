#pragma once

#include <string>

#include <rosbag/bag.h>

namespace tet_line_tracker {

/// Topics of a bag by what was asked for on the command line (empty: nothing). All throw std::runtime_error
/// with one sentence when the topic that was asked for is not there, or holds messages of another definition.

/// The topic asked for, or the only one with sensor_msgs/Image, or without such the only one with
/// CompressedImage; depth is left out. Throws when there is none, or several (option --image).
std::string chooseImageTopic(const rosbag::Bag& bag, const std::string& asked);
/// The camera_info asked for, or the only one, or of several the one beside `image_topic`; empty when the bag
/// has none. Throws when there are several others (option --camera-info).
std::string chooseCameraInfoTopic(const rosbag::Bag& bag, const std::string& asked,
                                  const std::string& image_topic);
/// The IMU asked for, or the only one of the bag; empty when there is none or more than one.
std::string chooseImuTopic(const rosbag::Bag& bag, const std::string& asked);
/// The odometry asked for, or the only one of the bag. Throws std::runtime_error when there is none or more
/// than one.
std::string chooseOdometryTopic(const rosbag::Bag& bag, const std::string& asked);

}  // namespace tet_line_tracker
