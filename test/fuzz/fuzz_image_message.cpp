#include <array>
#include <stdexcept>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "../../src/ros/image_conversion.h"
#include "fuzz_target.h"

using tet_line_tracker::Bytes;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<const char*, 16> kEncodings = {
      "mono8",  "8UC1",        "mono16",      "16UC1",        "bgr8",  "rgb8", "bgra8", "rgba8",
      "yuv422", "bayer_rggb8", "bayer_grbg8", "bayer_rggb16", "32FC1", "8UC3", "",      "nonsense"};
  Bytes bytes(data, size);
  sensor_msgs::Image image;
  image.encoding = kEncodings.at(bytes.take<std::uint8_t>() % kEncodings.size());
  // Mostly small sizes, which the data may fit; sometimes any.
  const bool any_size = bytes.take<std::uint8_t>() % 8 == 0;
  image.width = any_size ? bytes.take<std::uint32_t>() : bytes.take<std::uint8_t>() % 32;
  image.height = any_size ? bytes.take<std::uint32_t>() : bytes.take<std::uint8_t>() % 32;
  const auto step = bytes.take<std::uint32_t>();
  image.step = step % 4 == 0 ? step : image.width * (1 + step / 4 % 8);
  image.is_bigendian = bytes.take<std::uint8_t>() % 2;
  image.data.assign(bytes.begin(), bytes.end());
  if (step % 3 == 0 && image.step < 1024 && image.height < 1024) image.data.resize(image.step * image.height);
  try {
    const cv::Mat gray = tet_line_tracker::toGray(image, 1.0 / 256.0);
    if (gray.type() != CV_8UC1 || gray.cols != static_cast<int>(image.width) ||
        gray.rows != static_cast<int>(image.height)) {
      throw std::logic_error("gray image of another size or type");
    }
    volatile double sum = cv::sum(gray)[0];  // reads every pixel
    static_cast<void>(sum);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
