#include "geometry/segment_index.h"

#include <algorithm>
#include <cmath>

#include "geometry/clamp.h"

namespace tet_line_tracker {

bool areDuplicates(const LineSegment& a, const LineSegment& b, const DuplicateCriteria& criteria) {
  // The cheap tests first: nearly all pairs fail them.
  const Eigen::Vector2f u = a.end - a.start;
  const Eigen::Vector2f v = b.end - b.start;
  const float dot = u.dot(v);
  const float cross = u.x() * v.y() - u.y() * v.x();
  if (dot <= 0.0F || std::abs(cross) > criteria.max_tangent * dot) return false;
  const bool a_longer = u.squaredNorm() >= v.squaredNorm();
  const LineSegment& longer = a_longer ? a : b;
  const LineSegment& shorter = a_longer ? b : a;
  if (std::abs(longer.distance(shorter.middle())) > criteria.max_distance) return false;
  return overlap(shorter, longer) >= criteria.min_overlap;
}

void SegmentIndex::clear() {
  segments_.clear();
  next_.clear();
  heads_.fill(kNone);
}

void SegmentIndex::add(const LineSegment& segment) {
  int& head = heads_[static_cast<std::size_t>(sectorOf(segment))];
  next_.push_back(head);
  head = static_cast<int>(segments_.size());
  segments_.push_back(segment);
}

bool SegmentIndex::containsDuplicateOf(const LineSegment& segment) const {
  const int sector = sectorOf(segment);
  for (const int near : {sector, (sector + 1) % kSectors, (sector + kSectors - 1) % kSectors}) {
    for (int i = heads_[static_cast<std::size_t>(near)]; i != kNone; i = next_[static_cast<std::size_t>(i)]) {
      if (areDuplicates(segment, segments_[static_cast<std::size_t>(i)], criteria_)) return true;
    }
  }
  return false;
}

int SegmentIndex::sectorOf(const LineSegment& segment) {
  // A measure of the angle from 0 to 4 without a sine; a sector of it is at least 0.25 rad wide.
  const Eigen::Vector2f d = segment.end - segment.start;
  const float sum = std::abs(d.x()) + std::abs(d.y());
  const float share = sum > 0.0F ? d.y() / sum : 0.0F;
  const float angle = d.x() >= 0.0F ? 1.0F + share : 3.0F - share;
  return static_cast<int>(clampOrLow(0.25F * static_cast<float>(kSectors) * angle, 0.0F, kSectors - 1));
}

}  // namespace tet_line_tracker
