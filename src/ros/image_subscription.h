#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace tet_line_tracker {

/// An image as it came: one of both.
struct ImageMessage {
  sensor_msgs::ImageConstPtr raw;
  sensor_msgs::CompressedImageConstPtr compressed;
};

/// The images of a topic, by a transport of image_transport. Those of `compressed` come as they are: Debian
/// has no plugin for them, and one that gives way to a newer one in a queue need not be decoded.
class ImageSubscription {
 public:
  static constexpr char kCompressed[] = "compressed";
  using Callback = std::function<void(const ImageMessage&)>;

  /// `topic`: the base topic, which image_transport takes for the uncompressed images.
  ImageSubscription(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue_size,
                    const Callback& callback, const image_transport::TransportHints& hints);

  std::uint32_t publishers() const;

 private:
  image_transport::Subscriber decoded_;
  ros::Subscriber compressed_;
};

}  // namespace tet_line_tracker
