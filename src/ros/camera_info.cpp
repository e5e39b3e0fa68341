#include "camera_info.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

int saturated(std::uint32_t size) {
  constexpr auto kMax = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
  return static_cast<int>(std::min(size, kMax));
}

std::string sizeText(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info) {
  CameraCalibration calibration;
  calibration.model = info.distortion_model;
  calibration.width = saturated(info.width);
  calibration.height = saturated(info.height);
  calibration.fx = info.K[0];
  calibration.fy = info.K[4];
  calibration.cx = info.K[2];
  calibration.cy = info.K[5];
  calibration.distortion = info.D;
  return calibration;
}

sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration) {
  sensor_msgs::CameraInfo info;
  info.distortion_model = calibration.model;
  info.width = static_cast<std::uint32_t>(calibration.width);
  info.height = static_cast<std::uint32_t>(calibration.height);
  info.D = calibration.distortion;
  info.K = {calibration.fx, 0, calibration.cx, 0, calibration.fy, calibration.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {calibration.fx, 0, calibration.cx, 0, 0, calibration.fy, calibration.cy, 0, 0, 0, 1, 0};
  return info;
}

CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info) {
  if (info.K[0] == 0.0) return {nullptr, "the camera is not calibrated (K[0] of camera_info is 0)"};
  try {
    return {makeCameraModel(fromCameraInfo(info)), {}};
  } catch (const std::invalid_argument& error) {
    return {nullptr, std::string("camera_info cannot be used: ") + error.what()};
  }
}

CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height) {
  CameraChoice choice = chooseCamera(info);
  const std::string problem = sizeProblem(info, width, height);
  if (choice.camera == nullptr || problem.empty()) return choice;
  return {nullptr, problem};
}

std::string sizeProblem(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height) {
  const bool fits = (info.width == 0 || info.width == width) && (info.height == 0 || info.height == height);
  if (fits) return {};
  return "camera_info is for images of " + sizeText(info.width, info.height) + ", the images have " +
         sizeText(width, height);
}

}  // namespace tet_line_tracker
