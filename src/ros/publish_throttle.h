#pragma once

#include <cstdint>
#include <optional>

namespace tet_line_tracker {

/// Thins a stream of images to a rate by their stamps alone, so that the same images always give the same
/// choice. On the average the rate is kept even when the images do not come at a multiple of it; images that
/// come within kTolerance of the rate all pass.
class PublishThrottle {
 public:
  /// Deviation from the period that still counts as on time, as a share of the period.
  static constexpr double kTolerance = 0.1;

  /// `rate_hz` 0: every image passes. Throws std::invalid_argument when it is negative or not finite.
  explicit PublishThrottle(double rate_hz);

  /// Whether the image with this stamp [ns] passes. A stamp before the one of the image before
  /// starts anew.
  bool pass(std::int64_t stamp_ns);
  /// Of the images to come; another rate than before begins anew. Throws as the constructor.
  void setRate(double rate_hz);
  /// The next image passes.
  void reset() { due_ns_.reset(); }

 private:
  std::int64_t period_ns_;  ///< 0: every image
  std::int64_t tolerance_ns_;
  std::int64_t last_ns_{0};             ///< stamp of the image before, whether it passed or not
  std::optional<std::int64_t> due_ns_;  ///< stamp at which the next one passes
};

}  // namespace tet_line_tracker
