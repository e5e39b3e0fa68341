#include "calibration_input.h"

namespace tet_line_tracker {
namespace {

constexpr char kConsequence[] = "; lines are published in pixels, their normalised endpoints are NaN";

}  // namespace

std::optional<std::string> CalibrationInput::update(const sensor_msgs::CameraInfo& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (info_ && sameCalibration(info, *info_)) return std::nullopt;
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
