#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// What a detection policy decides by.
struct DetectionState {
  std::uint64_t images_in_epoch{0};       ///< this one included
  std::size_t images_since_detection{0};  ///< this one included
  std::size_t lines{0};                   ///< that are still tracked
  std::size_t lines_after_detection{0};   ///< after the last detection
  float coverage{0.0F};                   ///< share of the image that the lines cover, 0..1
  float coverage_after_detection{0.0F};   ///< after the last detection

  /// The detector has run, and this is what there is now.
  void setDetected(std::size_t line_count, float covered);
};

/// When to detect new lines. Const and without state.
class DetectionPolicy {
 public:
  virtual ~DetectionPolicy() = default;
  virtual bool isDue(const DetectionState& state) const = 0;
};

/// The paper: when fewer than min_lines are left.
std::unique_ptr<DetectionPolicy> makeMinLinesPolicy(const DetectionParameters& parameters);

/// On the first image; afterwards, every detection_interval images at most, when fewer than min_lines are
/// left or when the number of lines or their coverage has fallen below redetect_ratio.
std::unique_ptr<DetectionPolicy> makeReplenishPolicy(const DetectionParameters& parameters);

}  // namespace tet_line_tracker
