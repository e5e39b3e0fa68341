#pragma once

#include <vector>

#include "tet_line_tracker/line_segment.h"

namespace tet_line_tracker {

/// How near to each other two segments must be to be taken for the same edge of the image.
struct SameEdgeLimits {
  float turn{0.1F};      ///< tangent of the angle between them
  float distance{4.0F};  ///< of the middle of the shorter one from the longer one [px]
  float overlap{0.2F};   ///< share of the shorter one beside the longer one
};

/// True when two segments lie on the same edge: nearly parallel, nearly on one line, side by side. A dark
/// line on bright ground has two edges of opposite direction close together: those stay two lines.
bool onSameEdge(const LineSegment& a, const LineSegment& b, const SameEdgeLimits& limits);

/// True when `line` is on the same edge as one of `others`.
bool onSameEdge(const LineSegment& line, const std::vector<LineSegment>& others,
                const SameEdgeLimits& limits);

}  // namespace tet_line_tracker
