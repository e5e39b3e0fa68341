#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// A line in two images.
struct LineMatch {
  LineSegment before, after;
};

/// How many line matches agree on one homography between two images, found by RANSAC on infinite lines
/// (l' ~ H^-T l, four lines each time): endpoints need not correspond, so methods that detect anew in every
/// image are treated like methods that follow endpoints. A match agrees when both endpoints of the line
/// before, moved by H, are less than `max_error` from the infinite line after, and those of the line after,
/// moved back, from the line before [px]. Parallax is not part of the model: in a deep scene the share stays
/// below the true one. The same matches give the same result.
/// Gives one flag per match; with fewer than five matches there is nothing to agree on, and the result is
/// empty.
std::vector<bool> homographyInliers(const std::vector<LineMatch>& matches, double max_error,
                                    int hypotheses = 300);

}  // namespace tet_line_tracker
