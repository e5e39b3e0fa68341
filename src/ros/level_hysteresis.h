#pragma once

#include <string>

namespace tet_line_tracker {

/// Level and sentence of a status, as diagnostic_msgs has them.
struct StatusSummary {
  unsigned char level{0};  ///< 0: OK
  std::string message;
};

/// Keeps a status from flickering: trouble shows at once, and a while after it is over the status is still a
/// warning that names it. Not thread-safe.
class LevelHysteresis {
 public:
  static constexpr int kCalmReports = 5;  ///< without trouble until the status is OK again

  /// What to report when this is so now.
  StatusSummary update(const StatusSummary& now) {
    if (now.level != kOk) {
      trouble_ = now.message;
      calm_ = 0;
      return now;
    }
    if (trouble_.empty()) return now;
    if (++calm_ > kCalmReports) {
      trouble_.clear();
      return now;
    }
    return {kWarn, now.message + "; shortly before: " + trouble_};
  }
  /// Forgets trouble that is over.
  void reset() { trouble_.clear(); }

 private:
  static constexpr unsigned char kOk = 0;
  static constexpr unsigned char kWarn = 1;

  std::string trouble_;  ///< the last one; empty: none
  int calm_{0};          ///< reports since
};

/// A yes or no of a measured value, with a band between both in which it stays as it was.
class HysteresisThreshold {
 public:
  /// On below `low`, off from `high` on.
  HysteresisThreshold(double low, double high) : low_(low), high_(high) {}

  bool update(double value) {
    if (value < low_) on_ = true;
    if (value >= high_) on_ = false;
    return on_;
  }

 private:
  double low_, high_;
  bool on_{false};
};

}  // namespace tet_line_tracker
