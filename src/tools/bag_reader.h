#pragma once

#include <string>

#include <ros/message_traits.h>
#include <rosbag/bag.h>

namespace tet_line_tracker {

/// Opens a bag for reading. Throws std::runtime_error with the path and the reason.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// Throws std::runtime_error when messages on `topic` are of the type `type` by name and of another
/// definition than the one with `md5`: they cannot be read. Topics that are not there or of another type
/// pass.
void checkDefinition(const rosbag::Bag& bag, const std::string& topic, const std::string& type,
                     const std::string& md5);

/// The same for the definition that this program was built with.
template <class Message>
void checkDefinition(const rosbag::Bag& bag, const std::string& topic) {
  checkDefinition(bag, topic, ros::message_traits::datatype<Message>(),
                  ros::message_traits::md5sum<Message>());
}

}  // namespace tet_line_tracker
