#pragma once

#include <cmath>

namespace tet_line_tracker {

/// Chooses images of a stream as the trackers of VINS-Mono, PL-VIO and PL-VINS do: image at time t passes
/// while round(passed / (t - first)) <= frequency, and the count starts anew when the rate is within 1 %.
/// The first image never passes (1 / 0), as with them.
class FrequencyGate {
 public:
  explicit FrequencyGate(double frequency_hz) : frequency_hz_(frequency_hz) {}

  /// Whether the image with this stamp [s] passes. Call once per image, in order.
  bool pass(double stamp_s) {
    if (!started_) {
      started_ = true;
      first_s_ = stamp_s;
    }
    const double rate = passed_ / (stamp_s - first_s_);
    if (!(std::round(rate) <= frequency_hz_)) return false;
    if (std::abs(rate - frequency_hz_) < 0.01 * frequency_hz_) {
      first_s_ = stamp_s;
      passed_ = 0;
    }
    ++passed_;
    return true;
  }

 private:
  double frequency_hz_;
  bool started_{false};
  double first_s_{0.0};
  int passed_{1};
};

}  // namespace tet_line_tracker
