#pragma once

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// Whether at least half of the points of `line`, about one per 2 px, lie where `mask` (8-bit, one channel,
/// not empty) is not zero.
bool mostlyInMask(const LineCurve& line, const cv::Mat& mask);

}  // namespace tet_line_tracker
