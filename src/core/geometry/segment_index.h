#pragma once

#include <array>
#include <vector>

#include "tet_line_tracker/geometry/line_segment.h"

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

/// Segments among which one on the same edge as another is found by looking at those of its direction only.
class EdgeIndex {
 public:
  /// `limits`: of what is the same edge; turn at most 0.25.
  explicit EdgeIndex(const SameEdgeLimits& limits) : limits_(limits) { heads_.fill(kNone); }

  void clear();
  void add(const LineSegment& segment);
  /// True when `segment` is on the same edge as one that was added.
  bool holdsEdgeOf(const LineSegment& segment) const;

 private:
  static constexpr int kSectors = 16;
  static constexpr int kNone = -1;

  static int sectorOf(const LineSegment& segment);

  SameEdgeLimits limits_;
  std::vector<LineSegment> segments_;
  std::vector<int> next_;            ///< of each segment, in the same sector
  std::array<int, kSectors> heads_;  ///< last segment of each sector of directions
};

}  // namespace tet_line_tracker
