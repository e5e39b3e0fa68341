#pragma once

#include <chrono>

namespace tet_line_tracker {

/// Wall time since construction or the last lap.
class Stopwatch {
 public:
  /// Time since the lap before [ms].
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_{Clock::now()};
};

}  // namespace tet_line_tracker
