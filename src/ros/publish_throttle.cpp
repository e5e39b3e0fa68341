#include "publish_throttle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace tet_line_tracker {

PublishThrottle::PublishThrottle(double rate_hz) {
  if (!std::isfinite(rate_hz) || rate_hz < 0.0) {
    throw std::invalid_argument("publish rate is " + std::to_string(rate_hz) + " Hz, needs 0 or more");
  }
  period_ns_ = rate_hz > 0.0 ? std::llround(1e9 / rate_hz) : 0;
  tolerance_ns_ = std::llround(kTolerance * static_cast<double>(period_ns_));
}

void PublishThrottle::setRate(double rate_hz) {
  const PublishThrottle other(rate_hz);
  if (other.period_ns_ != period_ns_) *this = other;
}

bool PublishThrottle::pass(std::int64_t stamp_ns) {
  if (period_ns_ == 0) return true;
  if (!due_ns_ || stamp_ns < last_ns_) {
    last_ns_ = stamp_ns;
    due_ns_ = stamp_ns + period_ns_;
    return true;
  }
  const std::int64_t interval_ns = stamp_ns - last_ns_;
  last_ns_ = stamp_ns;
  // A camera that runs at about this rate has no image left out, however its clock drifts.
  if (std::abs(interval_ns - period_ns_) <= tolerance_ns_) {
    due_ns_ = stamp_ns + period_ns_;
    return true;
  }
  if (stamp_ns < *due_ns_ - std::min(tolerance_ns_, interval_ns / 2)) return false;
  // On the grid of the period the average stays right; a gap need not be caught up.
  due_ns_ = *due_ns_ + period_ns_ > stamp_ns ? *due_ns_ + period_ns_ : stamp_ns + period_ns_;
  return true;
}

}  // namespace tet_line_tracker
