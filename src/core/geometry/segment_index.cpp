#include "geometry/segment_index.h"

#include <algorithm>
#include <cmath>

#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

/// Tangent of the angle between a bent line and its chord, at most.
constexpr float kMaxBendSlope = 0.5F;
/// Of the middles of two lines that lie side by side, over the sum of their half lengths.
constexpr float kMaxSpread = 1.5F;

}  // namespace

bool areDuplicates(const LineCurve& a, const LineCurve& b, const DuplicateCriteria& criteria) {
  const Eigen::Vector2f u = a.chord.end - a.chord.start;
  const Eigen::Vector2f v = b.chord.end - b.chord.start;
  const bool a_longer = u.squaredNorm() >= v.squaredNorm();
  const LineCurve& longer = a_longer ? a : b;
  const LineCurve& shorter = a_longer ? b : a;
  const float dot = u.dot(v);
  const float cross = u.x() * v.y() - u.y() * v.x();
  if (dot <= 0.0F) return false;
  if (longer.bend.isStraight()) {
    if (std::abs(cross) > criteria.max_tangent * dot) return false;
  } else {
    if (std::abs(cross) > (criteria.max_tangent + kMaxBendSlope) * dot) return false;
    // The shorter one against the tangent of the longer one beside it. Its normal is to the left of its
    // direction: a curve that rises towards it turns left on screen, where cross is negative.
    const float length = longer.chord.length();
    const float place = std::clamp(longer.chord.along(shorter.chord.middle()) / length, 0.0F, 1.0F);
    const float slope = longer.bend.slope(place) / length;
    const float from_longer = (a_longer ? -cross : cross) / dot;
    if (std::abs(from_longer - slope) > criteria.max_tangent) return false;
  }
  if (std::abs(longer.distance(shorter.at(0.5F))) > criteria.max_distance) return false;
  return overlap(shorter.chord, longer.chord) >= criteria.min_overlap;
}

void SegmentIndex::clear() {
  all_straight_ = true;
  lines_.clear();
  next_.clear();
  heads_.fill(kNone);
}

void SegmentIndex::add(const LineCurve& line) {
  int& head = heads_[static_cast<std::size_t>(sectorOf(line.chord))];
  next_.push_back(head);
  head = static_cast<int>(lines_.size());
  lines_.push_back({line, line.chord.middle(), 0.5F * line.chord.length()});
  all_straight_ = all_straight_ && line.bend.isStraight();
}

bool SegmentIndex::containsDuplicateOf(const LineCurve& line) const {
  const int sector = sectorOf(line.chord);
  const Eigen::Vector2f direction = line.chord.end - line.chord.start;
  const bool straight = all_straight_ && line.bend.isStraight();
  const float max_tangent = criteria_.max_tangent + (straight ? 0.0F : kMaxBendSlope);
  const Eigen::Vector2f middle = line.chord.middle();
  const float reach = 0.5F * line.chord.length() + criteria_.max_distance;
  for (const int near : {sector, (sector + 1) % kSectors, (sector + kSectors - 1) % kSectors}) {
    for (int i = heads_[static_cast<std::size_t>(near)]; i != kNone; i = next_[static_cast<std::size_t>(i)]) {
      // The cheap tests first: nearly all pairs fail one of them.
      const Entry& other = lines_[static_cast<std::size_t>(i)];
      // Side by side they are within their half lengths, and a bend leaves its chord by less than that.
      const float farthest = kMaxSpread * (reach + other.half_length);
      if ((other.middle - middle).squaredNorm() > farthest * farthest) continue;
      const Eigen::Vector2f way = other.line.chord.end - other.line.chord.start;
      const float cross = direction.x() * way.y() - direction.y() * way.x();
      if (std::abs(cross) > max_tangent * direction.dot(way)) continue;
      if (areDuplicates(line, other.line, criteria_)) return true;
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
