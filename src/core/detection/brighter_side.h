#pragma once

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// Swaps the ends of `line` when its brighter side in `gray` (8-bit, one channel) lies to the right, so that
/// it lies to the left of direction() on screen. Precondition: length() > 0.
void turnBrighterSideLeft(const cv::Mat& gray, LineSegment& line);

}  // namespace tet_line_tracker
