#pragma once

#include <array>
#include <vector>

#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// When two segments are taken for the same edge of the image.
struct DuplicateCriteria {
  float max_tangent{0.1F};   ///< of the angle between them, at most 0.25
  float max_distance{4.0F};  ///< of the middle of the shorter one from the longer one [px]
  float min_overlap{0.2F};   ///< share of the shorter one that lies beside the longer one
};

/// True when two segments lie on the same edge: nearly parallel, nearly collinear, side by side. A dark line
/// on bright ground has two edges of opposite direction close together: those stay two lines.
bool areDuplicates(const LineCurve& a, const LineCurve& b, const DuplicateCriteria& criteria);

/// A set of lines, sorted by direction, that finds duplicates of another one quickly.
class SegmentIndex {
 public:
  explicit SegmentIndex(const DuplicateCriteria& criteria) : criteria_(criteria) { heads_.fill(kNone); }

  void clear();
  void add(const LineCurve& line);
  /// True when `line` is a duplicate of one that was added.
  bool containsDuplicateOf(const LineCurve& line) const;

 private:
  struct Entry {
    LineCurve line;
    Eigen::Vector2f middle;  ///< of the chord [px]
    float half_length;       ///< of the chord [px]
  };

  static constexpr int kSectors = 16;
  static constexpr int kNone = -1;

  static int sectorOf(const LineSegment& segment);

  DuplicateCriteria criteria_;
  bool all_straight_{true};
  std::vector<Entry> lines_;
  std::vector<int> next_;            ///< of each line, in the same sector
  std::array<int, kSectors> heads_;  ///< last segment of each sector of directions
};

}  // namespace tet_line_tracker
