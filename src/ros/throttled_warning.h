#pragma once

#include <chrono>
#include <optional>

namespace tet_line_tracker {

/// Lets a warning that recurs through once per period. Not ROS_WARN_THROTTLE: that counts simulated time,
/// which stands still, or has not begun, exactly when there is something to warn of. Not thread-safe.
class ThrottledWarning {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ThrottledWarning(std::chrono::seconds period = std::chrono::seconds(10)) : period_(period) {}

  /// Whether to warn now; if so, not again before the period is over.
  bool isDue(Clock::time_point now = Clock::now()) {
    if (last_ && now - *last_ < period_) return false;
    last_ = now;
    return true;
  }
  /// The trouble is over: a new one is warned of at once.
  void reset() { last_.reset(); }

 private:
  std::chrono::seconds period_;
  std::optional<Clock::time_point> last_;  ///< when it was let through
};

}  // namespace tet_line_tracker
