#pragma once

#include <cstddef>
#include <vector>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// One id of one epoch: the same line in consecutive images.
struct LineTrack {
  std::size_t first_frame{0};             ///< index of the image in which it begins
  std::vector<const TrackedLine*> lines;  ///< of this image and those after it
};

/// All tracks in the order in which they begin. An id that was away begins a new track (check_lines reports
/// it). `frames` must outlive the result.
std::vector<LineTrack> collectTracks(const std::vector<LineFrame>& frames);

}  // namespace tet_line_tracker
