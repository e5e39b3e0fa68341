#include "bag_image.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgcodecs.hpp>

#include <stdexcept>

#include "encoded_image.h"

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

std::string encodingOf(const cv::Mat& picture) {
  if (picture.type() == CV_8UC1) return encodings::MONO8;
  if (picture.type() == CV_8UC3) return encodings::BGR8;
  if (picture.type() == CV_8UC4) return encodings::BGRA8;
  if (picture.type() == CV_16UC1) return encodings::MONO16;
  throw std::invalid_argument("has " + std::to_string(picture.channels()) + " channels of " +
                              std::to_string(8 * picture.elemSize1()) +
                              " bits, needs 8-bit gray or colour, or 16-bit gray");
}

}  // namespace

std::optional<std_msgs::Header> imageHeader(const rosbag::MessageInstance& instance) {
  if (const auto image = instance.instantiate<sensor_msgs::Image>()) return image->header;
  if (const auto image = instance.instantiate<sensor_msgs::CompressedImage>()) return image->header;
  return std::nullopt;
}

sensor_msgs::ImageConstPtr readImage(const rosbag::MessageInstance& instance) {
  if (const auto image = instance.instantiate<sensor_msgs::Image>()) return image;
  const auto compressed = instance.instantiate<sensor_msgs::CompressedImage>();
  if (!compressed) return nullptr;
  try {
    const cv::Mat picture = decodePicture(compressed->data, cv::IMREAD_UNCHANGED);
    return cv_bridge::CvImage(compressed->header, encodingOf(picture), picture).toImageMsg();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("compressed image (" + compressed->format + ") " + error.what());
  }
}

}  // namespace tet_line_tracker
