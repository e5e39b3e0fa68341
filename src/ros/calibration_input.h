#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "camera_info.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "throttled_warning.h"

namespace tet_line_tracker {

/// Makes the camera model for the images from the camera_info that has come, whenever it comes, and warns of
/// each trouble with it once. Thread-safe.
class CalibrationInput {
 public:
  /// Images after which the absence of a camera_info is warned of.
  static constexpr int kPatienceImages = 20;

  /// Takes over a camera_info. Gives a sentence when it differs from the one before and cannot be used.
  std::optional<std::string> update(const sensor_msgs::CameraInfo& info);

  struct Model {
    std::shared_ptr<const CameraModel> camera;  ///< nullptr: none that fits
    std::optional<std::string> warning;         ///< to be logged now
  };
  /// Model for the next image, `width` x `height` [px].
  Model modelFor(int width, int height);

  /// Model in use, or why there is none for the last image; for people.
  std::string state() const;

 private:
  mutable std::mutex mutex_;  ///< guards everything below
  std::optional<sensor_msgs::CameraInfo> info_;
  CameraChoice choice_;  ///< for images of any size
  int images_without_{0};
  std::string size_problem_;  ///< of the last image
  ThrottledWarning size_warning_{std::chrono::seconds(60)};
};

}  // namespace tet_line_tracker
