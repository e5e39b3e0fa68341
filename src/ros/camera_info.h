#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Intrinsics (K, D, distortion_model, size) of a camera_info; binning and region of interest are not
/// applied. A size that int does not hold becomes the largest one.
CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info);

/// camera_info without header: K, D, P = [K 0], R = I.
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration);

/// What the node and track_bag make of a camera_info.
struct CameraChoice {
  std::shared_ptr<const CameraModel> camera;  ///< nullptr: normalised endpoints are NaN
  std::string problem;                        ///< why there is no camera; empty when there is one
};

/// The model of a camera_info; none when the camera is not calibrated (K[0] is 0, as sensor_msgs says) or the
/// calibration cannot be used.
CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info);
/// The same for images of `width` x `height` px: also none when the camera_info is for images of another
/// size. A side of 0 in the camera_info fits every image.
CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height);

/// Why a camera_info is not for images of this size [px]; empty when it is.
std::string sizeProblem(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height);

}  // namespace tet_line_tracker
