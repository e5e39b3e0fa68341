#pragma once

#include <optional>

#include <rosbag/message_instance.h>
#include <sensor_msgs/Image.h>

namespace tet_line_tracker {

/// Header of a sensor_msgs/Image or CompressedImage; nothing for a message of another type. Throws
/// ros::serialization::StreamOverrunException when the message is cut off.
std::optional<std_msgs::Header> imageHeader(const rosbag::MessageInstance& instance);

/// The image of a sensor_msgs/Image, or of a CompressedImage that is decoded as the transport plugin
/// `compressed` does (mono8, bgr8, bgra8 or mono16); nullptr for a message of another type. Throws
/// std::invalid_argument with one sentence when it cannot be decoded.
sensor_msgs::ImageConstPtr readImage(const rosbag::MessageInstance& instance);

}  // namespace tet_line_tracker
