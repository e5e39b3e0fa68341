#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Makes the camera model for the images from the camera_info that has come, whenever it comes, and tells
/// each trouble with it once. Thread-safe.
class CalibrationInput {
 public:
  /// Images after which the absence of a camera_info is told.
  static constexpr int kPatienceImages = 20;

  /// Takes over a camera_info. Gives a sentence when it differs from the one before and cannot be used.
  std::optional<std::string> update(const sensor_msgs::CameraInfo& info);

  struct Model {
    std::shared_ptr<const CameraModel> camera;  ///< nullptr: none that fits
    std::optional<std::string> complaint;       ///< to be told now
  };
  /// Model for the next image, `width` x `height` [px].
  Model modelFor(int width, int height);

  /// Model in use, or why there is none; for people.
  std::string state() const;

 private:
  mutable std::mutex mutex_;  ///< guards everything below
  std::optional<CameraCalibration> calibration_;
  std::shared_ptr<const CameraModel> camera_;
  std::string state_{"no camera_info so far"};
  int images_without_{0};
  bool mismatch_told_{false};
};

}  // namespace tet_line_tracker
