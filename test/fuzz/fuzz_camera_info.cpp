#include <array>
#include <stdexcept>

#include <sensor_msgs/CameraInfo.h>

#include "../../src/ros/camera_info.h"
#include "fuzz_target.h"
#include "tet_line_tracker/camera/camera_model.h"

using tet_line_tracker::Bytes;
using tet_line_tracker::takeNumber;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<const char*, 6> kModels = {
      "plumb_bob", "rational_polynomial", "equidistant", "mei", "", "fov"};
  Bytes bytes(data, size);
  sensor_msgs::CameraInfo info;
  info.width = bytes.take<std::uint16_t>();
  info.height = bytes.take<std::uint16_t>();
  info.distortion_model = kModels.at(bytes.take<std::uint8_t>() % kModels.size());
  for (std::size_t i = bytes.take<std::uint8_t>() % 10; i > 0; --i)
    info.D.push_back(takeNumber(bytes, 4.0, 4));
  for (double& value : info.K) value = takeNumber(bytes, 2000.0, 4);
  if (bytes.take<std::uint8_t>() % 2 == 0) {
    info.roi.x_offset = bytes.take<std::uint16_t>();
    info.roi.width = bytes.take<std::uint32_t>();
    info.binning_y = bytes.take<std::uint32_t>();
  }
  try {
    const auto camera = tet_line_tracker::chooseCamera(info).camera;
    if (camera == nullptr) return 0;
    for (const double share : {0.0, 0.4, 1.0}) {
      const Eigen::Vector2d pixel(share * info.width, share * info.height);
      const auto normalized = camera->normalize(pixel);
      if (normalized && !normalized->allFinite()) throw std::logic_error("a normalised point is not finite");
      const auto ray = camera->unproject(pixel);
      if (ray && !ray->allFinite()) throw std::logic_error("a ray is not finite");
      // Absurd focal lengths may put a pixel at infinity; only crashes count.
      camera->project(ray.value_or(Eigen::Vector3d(share, -share, 1.0)));
    }
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
