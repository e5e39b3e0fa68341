#include "calibration_input.h"

#include <stdexcept>

#include "camera_info.h"

namespace tet_line_tracker {
namespace {

bool same(const CameraCalibration& a, const CameraCalibration& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
}

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

std::optional<std::string> CalibrationInput::update(const sensor_msgs::CameraInfo& info) {
  const CameraCalibration calibration = fromCameraInfo(info);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (calibration_ && same(calibration, *calibration_)) return std::nullopt;
  calibration_ = calibration;
  mismatch_told_ = false;
  try {
    camera_ = makeCameraModel(calibration);
    state_ = calibration.model + ", " + sizeText(calibration.width, calibration.height);
    return std::nullopt;
  } catch (const std::invalid_argument& error) {
    camera_.reset();
    state_ = std::string("camera_info cannot be used: ") + error.what();
    return state_ + "; lines are published in pixels, their normalised endpoints are NaN";
  }
}

CalibrationInput::Model CalibrationInput::modelFor(int width, int height) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!calibration_) {
    ++images_without_;
    if (images_without_ != kPatienceImages) return {};
    return {nullptr, "no camera_info after " + std::to_string(kPatienceImages) +
                         " images; lines are published in pixels, their normalised endpoints are NaN"};
  }
  if (!camera_) return {};
  const bool fits = (calibration_->width == 0 || calibration_->width == width) &&
                    (calibration_->height == 0 || calibration_->height == height);
  if (fits) return {camera_, std::nullopt};
  if (mismatch_told_) return {};
  mismatch_told_ = true;
  return {nullptr, "camera_info is for images of " + sizeText(calibration_->width, calibration_->height) +
                       ", the images have " + sizeText(width, height) +
                       "; lines are published in pixels, their normalised endpoints are NaN"};
}

std::string CalibrationInput::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return mismatch_told_ ? state_ + ", does not fit the images" : state_;
}

}  // namespace tet_line_tracker
