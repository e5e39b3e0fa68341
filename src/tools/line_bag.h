#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// The lines that a bag holds, in the order of recording.
struct LineBag {
  std::vector<LineFrame> frames;
  bool has_statistics{false};  ///< every frame carries the times of its statistics message
};

/// Reads the LineArrays of `topic`, with the TrackingStatistics of its sister topic "statistics" where there
/// are some. Throws std::runtime_error when the bag holds none.
LineBag readLines(const rosbag::Bag& bag, const std::string& topic);

}  // namespace tet_line_tracker
