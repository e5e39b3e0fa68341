#include "bag_image.h"

#include <sensor_msgs/CompressedImage.h>

#include "../ros/encoded_image.h"

namespace tet_line_tracker {

std::optional<std_msgs::Header> imageHeader(const rosbag::MessageInstance& instance) {
  if (const auto image = instance.instantiate<sensor_msgs::Image>()) return image->header;
  if (const auto image = instance.instantiate<sensor_msgs::CompressedImage>()) return image->header;
  return std::nullopt;
}

sensor_msgs::ImageConstPtr readImage(const rosbag::MessageInstance& instance) {
  if (const auto image = instance.instantiate<sensor_msgs::Image>()) return image;
  const auto compressed = instance.instantiate<sensor_msgs::CompressedImage>();
  if (!compressed) return nullptr;
  return decompress(*compressed, DecoderWarnings::kAreDamage).toImageMsg();
}

}  // namespace tet_line_tracker
