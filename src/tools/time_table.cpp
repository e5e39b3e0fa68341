#include "time_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tet_line_tracker {

void TimeTable::add(const FrameStatistics& statistics) {
  add("pyramid", statistics.pyramid_ms);
  add("prior", statistics.prior_ms);
  add("flow", statistics.flow_ms);
  add("refine", statistics.refine_ms);
  add("detect", statistics.detect_ms);
  add("undistort", statistics.undistort_ms);
  add("total", statistics.total_ms);
}

void TimeTable::add(const std::string& stage, double ms) {
  auto& times = times_[stage];
  if (times.empty()) order_.push_back(stage);
  times.push_back(ms);
}

void TimeTable::print() {
  std::printf("%-12s %9s %9s %9s %9s\n", "ms", "mean", "median", "p99", "max");
  for (const std::string& stage : order_) {
    std::vector<double>& times = times_[stage];
    std::sort(times.begin(), times.end());
    double sum = 0.0;
    for (const double time : times) sum += time;
    const auto at = [&times](double share) {
      return times[static_cast<std::size_t>(std::lround(share * static_cast<double>(times.size() - 1)))];
    };
    std::printf("%-12s %9.3f %9.3f %9.3f %9.3f\n", stage.c_str(), sum / static_cast<double>(times.size()),
                at(0.5), at(0.99), times.back());
  }
}

}  // namespace tet_line_tracker
