#include "calibration_input.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {
namespace {

constexpr char kConsequence[] = "; lines are published in pixels, their normalised endpoints are NaN";

/// Equal, or both NaN: a calibration of NaN is the same one each time it comes.
bool sameNumber(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.distortion_model == b.distortion_model && a.width == b.width && a.height == b.height &&
         a.binning_x == b.binning_x && a.binning_y == b.binning_y && a.roi.x_offset == b.roi.x_offset &&
         a.roi.y_offset == b.roi.y_offset && a.roi.width == b.roi.width && a.roi.height == b.roi.height &&
         std::equal(a.K.begin(), a.K.end(), b.K.begin(), b.K.end(), sameNumber) &&
         std::equal(a.D.begin(), a.D.end(), b.D.begin(), b.D.end(), sameNumber);
}

}  // namespace

std::optional<std::string> CalibrationInput::update(const sensor_msgs::CameraInfo& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (info_ && same(info, *info_)) return std::nullopt;
  info_ = info;
  choice_ = chooseCamera(info);
  size_problem_.clear();
  size_warning_.reset();
  if (choice_.camera) return std::nullopt;
  return choice_.problem + kConsequence;
}

CalibrationInput::Model CalibrationInput::modelFor(int width, int height) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!info_) {
    if (++images_without_ != kPatienceImages) return {};
    return {nullptr, "no camera_info after " + std::to_string(kPatienceImages) + " images" + kConsequence};
  }
  if (!choice_.camera) return {};
  size_problem_ = sizeProblem(*info_, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  if (size_problem_.empty()) return {choice_.camera, std::nullopt};
  if (!size_warning_.isDue()) return {};
  return {nullptr, size_problem_ + kConsequence};
}

std::string CalibrationInput::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!info_) return "no camera_info so far";
  if (!choice_.camera) return choice_.problem;
  if (!size_problem_.empty()) return size_problem_;
  const std::string& model = info_->distortion_model;
  return (model.empty() ? "no distortion" : model) + ", " + imageText(*info_);
}

}  // namespace tet_line_tracker
