#include "tracking/detection_policy.h"

namespace tet_line_tracker {

void DetectionState::setDetected(std::size_t line_count, float covered) {
  images_since_detection = 0;
  lines_after_detection = line_count;
  coverage = covered;
  coverage_after_detection = covered;
}

namespace {

class MinLinesPolicy : public DetectionPolicy {
 public:
  explicit MinLinesPolicy(const DetectionParameters& parameters)
      : min_lines_(static_cast<std::size_t>(parameters.min_lines)) {}
  bool isDue(const DetectionState& state) const override { return state.lines < min_lines_; }

 private:
  std::size_t min_lines_;
};

class ReplenishPolicy : public DetectionPolicy {
 public:
  explicit ReplenishPolicy(const DetectionParameters& parameters)
      : min_lines_(static_cast<std::size_t>(parameters.min_lines)),
        interval_(static_cast<std::size_t>(parameters.detection_interval)),
        ratio_(parameters.redetect_ratio) {}

  bool isDue(const DetectionState& state) const override {
    if (state.images_in_epoch == 1) return true;
    // Most lines are gone at once: no image goes without.
    if (2 * state.lines < state.lines_after_detection) return true;
    if (state.images_since_detection < interval_) return false;
    return state.lines < min_lines_ ||
           static_cast<double>(state.lines) < ratio_ * static_cast<double>(state.lines_after_detection) ||
           static_cast<double>(state.coverage) < ratio_ * static_cast<double>(state.coverage_after_detection);
  }

 private:
  std::size_t min_lines_;
  std::size_t interval_;
  double ratio_;
};

}  // namespace

std::unique_ptr<DetectionPolicy> makeMinLinesPolicy(const DetectionParameters& parameters) {
  return std::make_unique<MinLinesPolicy>(parameters);
}

std::unique_ptr<DetectionPolicy> makeReplenishPolicy(const DetectionParameters& parameters) {
  return std::make_unique<ReplenishPolicy>(parameters);
}

}  // namespace tet_line_tracker
