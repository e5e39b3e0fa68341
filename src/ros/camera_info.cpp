#include "camera_info.h"

#include <algorithm>
#include <limits>

namespace tet_line_tracker {
namespace {

/// A size beyond int stays as far beyond any image.
int toInt(std::uint32_t size) {
  return static_cast<int>(std::min<std::uint32_t>(size, std::numeric_limits<int>::max()));
}

}  // namespace

CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info) {
  CameraCalibration calibration;
  calibration.model = info.distortion_model;
  calibration.width = toInt(info.width);
  calibration.height = toInt(info.height);
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

}  // namespace tet_line_tracker
