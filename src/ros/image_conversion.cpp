#include "image_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <map>
#include <stdexcept>
#include <string>

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

/// Larger sides are a broken message: no camera has them, and OpenCV's remapping ends there as well.
constexpr std::uint32_t kMaxSide = 32767;

struct PixelLayout {
  std::uint32_t bytes;    ///< per pixel
  std::uint32_t channel;  ///< bytes per channel
};

const std::map<std::string, PixelLayout>& acceptedEncodings() {
  static const std::map<std::string, PixelLayout> accepted{
      {encodings::MONO8, {1, 1}},       {encodings::TYPE_8UC1, {1, 1}},   {encodings::MONO16, {2, 2}},
      {encodings::TYPE_16UC1, {2, 2}},  {encodings::BGR8, {3, 1}},        {encodings::RGB8, {3, 1}},
      {encodings::BGRA8, {4, 1}},       {encodings::RGBA8, {4, 1}},       {encodings::BAYER_RGGB8, {1, 1}},
      {encodings::BAYER_BGGR8, {1, 1}}, {encodings::BAYER_GBRG8, {1, 1}}, {encodings::BAYER_GRBG8, {1, 1}},
      {encodings::YUV422, {2, 1}}};
  return accepted;
}

/// Checks the message before its memory is touched.
void checkLayout(const sensor_msgs::Image& image) {
  const auto layout = acceptedEncodings().find(image.encoding);
  if (layout == acceptedEncodings().end()) {
    throw std::invalid_argument("image encoding is " + (image.encoding.empty() ? "empty" : image.encoding) +
                                ", needs mono8, 8UC1, mono16, 16UC1, bgr8, rgb8, bgra8, rgba8, bayer_*8 or "
                                "yuv422");
  }
  const std::string seen =
      "image of " + std::to_string(image.width) + "x" + std::to_string(image.height) + " " + image.encoding;
  if (image.width == 0 || image.height == 0 || image.width > kMaxSide || image.height > kMaxSide) {
    throw std::invalid_argument(seen + " has a size outside 1.." + std::to_string(kMaxSide) + " px");
  }
  const std::uint64_t row_bytes = std::uint64_t{image.width} * layout->second.bytes;
  if (image.step < row_bytes || image.step % layout->second.channel != 0) {
    throw std::invalid_argument(seen + " has a step of " + std::to_string(image.step) +
                                " bytes, needs whole values and at least " + std::to_string(row_bytes));
  }
  const std::uint64_t bytes = std::uint64_t{image.step} * image.height;
  if (image.data.size() < bytes) {
    throw std::invalid_argument(seen + " has " + std::to_string(image.data.size()) +
                                " bytes of data, needs " + std::to_string(bytes));
  }
}

cv::Mat sharedView(const sensor_msgs::Image& image, int type) {
  // cv::Mat knows no const memory; callers of toGray() only read.
  auto* data = const_cast<std::uint8_t*>(image.data.data());
  return {static_cast<int>(image.height), static_cast<int>(image.width), type, data, image.step};
}

/// Copy of a 16-bit image with the two bytes of each value exchanged; cv_bridge 1.16 gives zeros here.
cv::Mat byteSwapped(const cv::Mat& wide) {
  cv::Mat swapped(wide.size(), wide.type());
  for (int y = 0; y < wide.rows; ++y) {
    const auto* from = wide.ptr<std::uint16_t>(y);
    auto* to = swapped.ptr<std::uint16_t>(y);
    for (int x = 0; x < wide.cols; ++x) to[x] = static_cast<std::uint16_t>((from[x] << 8) | (from[x] >> 8));
  }
  return swapped;
}

bool hostIsBigEndian() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const std::uint8_t*>(&one) == 0;
}

}  // namespace

cv::Mat toGray(const sensor_msgs::Image& image, double mono16_scale) {
  checkLayout(image);
  if (image.encoding == encodings::MONO8 || image.encoding == encodings::TYPE_8UC1) {
    return sharedView(image, CV_8UC1);
  }
  try {
    if (image.encoding == encodings::MONO16 || image.encoding == encodings::TYPE_16UC1) {
      const bool swap = (image.is_bigendian != 0) != hostIsBigEndian();
      const cv::Mat wide = sharedView(image, CV_16UC1);
      cv::Mat gray;
      (swap ? byteSwapped(wide) : wide).convertTo(gray, CV_8U, mono16_scale);
      return gray;
    }
    return cv_bridge::toCvCopy(image, encodings::MONO8)->image;
  } catch (const std::exception& error) {
    throw std::invalid_argument("image of encoding " + image.encoding +
                                " cannot be converted to gray: " + error.what());
  }
}

GrayImage readGray(const sensor_msgs::Image& image, double mono16_scale) {
  try {
    return {toGray(image, mono16_scale), {}};
  } catch (const std::invalid_argument& error) {
    return {{}, error.what()};
  }
}

}  // namespace tet_line_tracker
