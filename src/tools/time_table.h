#pragma once

#include <map>
#include <string>
#include <vector>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Times of each stage over all images.
class TimeTable {
 public:
  void add(const FrameStatistics& statistics);
  void add(const std::string& stage, double ms);
  /// Mean, median, 99th percentile and maximum of each stage [ms], to the standard output.
  void print();

 private:
  std::map<std::string, std::vector<double>> times_;
  std::vector<std::string> order_;
};

}  // namespace tet_line_tracker
