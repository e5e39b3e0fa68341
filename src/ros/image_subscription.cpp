#include "image_subscription.h"

#include "silence_warning.h"

namespace tet_line_tracker {

ImageSubscription::ImageSubscription(ros::NodeHandle& node, const std::string& topic,
                                     std::uint32_t queue_size, const Callback& callback,
                                     const image_transport::TransportHints& hints) {
  if (hints.getTransport() == kCompressed) {
    compressed_ = node.subscribe<sensor_msgs::CompressedImage>(
        topicOfTransport(topic, kCompressed), queue_size,
        [callback](const sensor_msgs::CompressedImageConstPtr& image) {
          callback({nullptr, image});
        },
        ros::VoidConstPtr(), hints.getRosHints());
  } else {
    decoded_ = image_transport::ImageTransport(node).subscribe(
        topic, queue_size,
        [callback](const sensor_msgs::ImageConstPtr& image) {
          callback({image, nullptr});
        },
        ros::VoidPtr(), hints);
  }
}

std::uint32_t ImageSubscription::publishers() const {
  return compressed_ ? compressed_.getNumPublishers() : decoded_.getNumPublishers();
}

}  // namespace tet_line_tracker
