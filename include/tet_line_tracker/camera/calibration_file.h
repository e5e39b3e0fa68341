#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// One camera of a calibration file.
struct CalibrationFile {
  std::string format;  ///< "camera_info", "kalibr" or "camodocal"
  std::string name;    ///< of the camera in the file; empty: not said
  CameraCalibration camera;
  /// Moves a point from the IMU's frame to the camera's optical frame, when the file says so (Kalibr's
  /// T_cam_imu, the extrinsicRotation and extrinsicTranslation or body_T_cam of VINS).
  std::optional<Eigen::Isometry3d> camera_from_imu;
  /// Stamp of the IMU less that of the camera at the same moment [s], when the file says so (Kalibr's
  /// timeshift_cam_imu, VINS's td): the value of the parameter imu_time_offset.
  std::optional<double> imu_time_offset{};
};

/// Reads a calibration in any of these formats, which it tells apart by their keys:
/// - camera_info YAML as camera_calibration and camera_info_manager write it, and a sensor_msgs/CameraInfo as
///   `rostopic echo` prints it,
/// - Kalibr camchain YAML (pinhole with radtan, equi or none; omni with radtan or none),
/// - YAML of camodocal and VINS (PINHOLE, KANNALA_BRANDT, MEI), with OpenCV's "%YAML:1.0" header or without.
/// `camera` is the index in a Kalibr chain (cam0, cam1, ...) and of VINS's body_T_cam. Throws
/// std::runtime_error with one sentence that names the file and the field at fault.
CalibrationFile readCalibrationFile(const std::string& path, int camera = 0);

}  // namespace tet_line_tracker
