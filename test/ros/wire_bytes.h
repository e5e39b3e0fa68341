#pragma once

#include <cstdint>
#include <vector>

#include <ros/serialization.h>

namespace tet_line_tracker {

using Bytes = std::vector<std::uint8_t>;

/// A message as it goes over the wire.
template <class Message>
Bytes bytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

}  // namespace tet_line_tracker
