#include "camera_info.h"

namespace tet_line_tracker {

CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info) {
  CameraCalibration calibration;
  calibration.model = info.distortion_model;
  calibration.width = static_cast<int>(info.width);
  calibration.height = static_cast<int>(info.height);
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
