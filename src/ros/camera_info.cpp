#include "camera_info.h"

#include <algorithm>
#include <cmath>
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

/// What the sensor reads out along one axis [px of the full image].
struct Readout {
  std::uint32_t full;     ///< side of the full image; 0: not said
  std::uint32_t offset;   ///< where the region of interest begins
  std::uint32_t region;   ///< its side; 0: the rest
  std::uint32_t binning;  ///< 0 and 1: none

  std::uint32_t pixelsPerPixel() const { return std::max(binning, 1U); }
  /// Side of the image that comes; 0: not said.
  std::uint32_t side() const {
    const std::uint32_t rest = full > offset ? full - offset : 0;
    return (region != 0 ? region : rest) / pixelsPerPixel();
  }
  double focalLength(double of_full) const { return of_full / pixelsPerPixel(); }
  double centre(double of_full) const { return (of_full - offset) / pixelsPerPixel(); }
  bool isInside() const { return full == 0 || std::uint64_t{offset} + std::max(region, 1U) <= full; }
  bool leavesNothing() const { return (full != 0 || region != 0) && side() == 0; }
};

Readout across(const sensor_msgs::CameraInfo& info) {
  return {info.width, info.roi.x_offset, info.roi.width, info.binning_x};
}

Readout down(const sensor_msgs::CameraInfo& info) {
  return {info.height, info.roi.y_offset, info.roi.height, info.binning_y};
}

/// How the image comes from the full one, for people; empty: it is the full one.
std::string readoutText(const sensor_msgs::CameraInfo& info) {
  const Readout x = across(info);
  const Readout y = down(info);
  std::string text;
  if (x.offset != 0 || y.offset != 0 || x.region != 0 || y.region != 0) {
    text += ", region of interest " + sizeText(x.region, y.region) + " at (" + std::to_string(x.offset) +
            ", " + std::to_string(y.offset) + ")";
  }
  if (x.pixelsPerPixel() != 1 || y.pixelsPerPixel() != 1) {
    text += ", binning " + sizeText(x.pixelsPerPixel(), y.pixelsPerPixel());
  }
  return text.empty() ? text : " (" + sizeText(info.width, info.height) + text + ")";
}

/// Why binning and region of interest cannot be meant; empty when they can.
std::string readoutProblem(const sensor_msgs::CameraInfo& info) {
  const Readout x = across(info);
  const Readout y = down(info);
  if (!x.isInside() || !y.isInside()) {
    return "its region of interest is not inside the full image" + readoutText(info);
  }
  if (x.leavesNothing() || y.leavesNothing()) {
    return "its binning leaves no pixel of the image" + readoutText(info);
  }
  return {};
}

/// Equal, or both NaN: a calibration of NaN is the same one each time it comes.
bool sameNumber(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

CameraCalibration fromCameraInfo(const sensor_msgs::CameraInfo& info) {
  CameraCalibration calibration;
  calibration.model = info.distortion_model;
  const Readout x = across(info);
  const Readout y = down(info);
  calibration.width = saturated(x.side());
  calibration.height = saturated(y.side());
  calibration.fx = x.focalLength(info.K[0]);
  calibration.fy = y.focalLength(info.K[4]);
  calibration.cx = x.centre(info.K[2]);
  calibration.cy = y.centre(info.K[5]);
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
  const std::string problem = readoutProblem(info);
  if (!problem.empty()) return {nullptr, "camera_info cannot be used: " + problem};
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

bool sameCalibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.distortion_model == b.distortion_model && a.width == b.width && a.height == b.height &&
         a.binning_x == b.binning_x && a.binning_y == b.binning_y && a.roi.x_offset == b.roi.x_offset &&
         a.roi.y_offset == b.roi.y_offset && a.roi.width == b.roi.width && a.roi.height == b.roi.height &&
         std::equal(a.K.begin(), a.K.end(), b.K.begin(), b.K.end(), sameNumber) &&
         std::equal(a.D.begin(), a.D.end(), b.D.begin(), b.D.end(), sameNumber);
}

std::string sizeProblem(const sensor_msgs::CameraInfo& info, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t wide = across(info).side();
  const std::uint32_t high = down(info).side();
  if ((wide == 0 || wide == width) && (high == 0 || high == height)) return {};
  return "camera_info is for images of " + sizeText(wide, high) + readoutText(info) + ", the images have " +
         sizeText(width, height);
}

std::string imageText(const sensor_msgs::CameraInfo& info) {
  return sizeText(across(info).side(), down(info).side()) + readoutText(info);
}

}  // namespace tet_line_tracker
