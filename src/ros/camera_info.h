#pragma once

#include <sensor_msgs/CameraInfo.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Intrinsics (K, D, distortion_model, size) of a camera_info; binning and region of interest are not
/// applied.
CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info);

/// camera_info without header: K, D, P = [K 0], R = I.
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration);

}  // namespace tet_line_tracker
