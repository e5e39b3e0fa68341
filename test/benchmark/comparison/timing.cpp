#include "timing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numeric>

namespace tet_line_tracker {

double Times::threadMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double Times::quantile(double share) const {
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  const double last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(share * last))];
}

double Times::mean() const {
  return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
}

void TimeTable::add(const std::string& name, const Times& times, const std::string& remark) {
  rows_.push_back({name, times, remark});
}

void TimeTable::print(std::size_t reference) const {
  std::printf("\n| %s | min | median | mean | p99 | p99 / mean | ratio |%s\n", what_.c_str(),
              remark_.empty() ? "" : (" " + remark_ + " |").c_str());
  std::printf("|---|---|---|---|---|---|---|%s\n", remark_.empty() ? "" : "---|");
  for (const Row& row : rows_) {
    const Times& t = row.times;
    std::printf("| %s | %.3f | %.3f | %.3f | %.3f | %.1f | %.2f |", row.name.c_str(), t.minimum(), t.median(),
                t.mean(), t.percentile99(), t.percentile99() / t.mean(),
                rows_[reference].times.mean() / t.mean());
    std::printf("%s\n", remark_.empty() ? "" : (" " + row.remark + " |").c_str());
  }
}

double fittedExponent(const std::vector<double>& sizes, const std::vector<double>& costs) {
  double x_mean = 0.0;
  double y_mean = 0.0;
  const double count = static_cast<double>(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    x_mean += std::log(sizes[i]) / count;
    y_mean += std::log(costs[i]) / count;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - x_mean;
    xx += x * x;
    xy += x * (std::log(costs[i]) - y_mean);
  }
  return xy / xx;
}

}  // namespace tet_line_tracker
