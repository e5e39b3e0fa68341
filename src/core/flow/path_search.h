#pragma once

#include <array>
#include <cstddef>

#include <opencv2/core.hpp>

#include "flow/patch_flow.h"
#include "kernels/kernels.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"

namespace tet_line_tracker {

/// Tries the patches of a line on one pyramid level at every place of `path` [px of the original image].
/// Since inverse depth is linear along the image of a straight line, a patch at fraction s between an end at
/// step a and one at step b is at step (1 - s) a + s b. Writes the pairs (a, b) that fit best, best first,
/// and returns how many.
std::size_t searchPath(const PatchRow& row, const kernels::PatchShape& shape, const cv::Mat& image,
                       float scale, const LinePath& path,
                       std::array<LineSegment, EndpointTracker::kMaxStarts>& best);

}  // namespace tet_line_tracker
