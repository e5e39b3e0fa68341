#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Intrinsics of the image that comes: K, D, distortion_model and size of a camera_info are those of the full
/// image, of which the camera reads out the region of interest (roi; all zero: the whole) in pixels of
/// `binning` full ones. As image_geometry has it, f is divided by the binning, and c less the offset too. A
/// size that int does not hold becomes the largest one.
CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info);

/// camera_info without header: K, D, P = [K 0], R = I.
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration);

/// What the node and track_bag make of a camera_info.
struct CameraChoice {
  std::shared_ptr<const CameraModel> camera;  ///< nullptr: normalised endpoints are NaN
  std::string problem;                        ///< why there is no camera; empty when there is one
};

/// The model of a camera_info; none when the camera is not calibrated (K[0] is 0, as sensor_msgs says) or the
/// calibration, binning or region of interest cannot be used.
CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info);
/// The same for images of `width` x `height` px: also none when the camera_info is for images of another
/// size. A side of 0 in the camera_info fits every image.
CameraChoice chooseCamera(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height);

/// Whether fromCameraInfo() gives the same of both, NaN included.
bool sameCalibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b);

/// Size of the images that a camera_info is for, and how they come from the full one; for people.
std::string imageText(const sensor_msgs::CameraInfo& info);

/// Why a camera_info is not for images of this size [px]; empty when it is.
std::string sizeProblem(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height);

}  // namespace tet_line_tracker
