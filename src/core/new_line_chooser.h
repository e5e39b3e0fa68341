#pragma once

#include <cstddef>
#include <vector>

#include "tet_line_tracker/line_segment.h"

namespace tet_line_tracker {

/// How near to each other two segments must be to be taken for the same edge of the image.
struct SameEdgeLimits {
  float angle{0.1F};     ///< [rad]
  float distance{4.0F};  ///< of the middle of the shorter one from the longer one [px]
  float overlap{0.2F};   ///< share of the shorter one beside the longer one
};

/// True when two segments lie on the same edge: nearly parallel, nearly on one line, side by side. A dark
/// line on bright ground has two edges of opposite direction close together: those stay two lines.
bool onSameEdge(const LineSegment& a, const LineSegment& b, const SameEdgeLimits& limits);

/// Sorts `candidates` so that the best to track come first (longest; by coordinates where lengths are equal,
/// so that the order does not depend on the detector's), drops those on the same edge as a segment of
/// `tracked` or as a better candidate, and keeps at most `count`.
void chooseNewLines(const std::vector<LineSegment>& tracked, std::size_t count,
                    std::vector<LineSegment>& candidates);

}  // namespace tet_line_tracker
