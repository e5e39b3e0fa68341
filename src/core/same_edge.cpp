#include "same_edge.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {

bool onSameEdge(const LineSegment& a, const LineSegment& b, const SameEdgeLimits& limits) {
  // The cheap tests first: nearly all pairs fail them.
  const Eigen::Vector2f u = a.end - a.start;
  const Eigen::Vector2f v = b.end - b.start;
  const float dot = u.dot(v);
  const float cross = u.x() * v.y() - u.y() * v.x();
  if (dot <= 0.0F || std::abs(cross) > limits.turn * dot) return false;
  const bool a_longer = u.squaredNorm() >= v.squaredNorm();
  const LineSegment& longer = a_longer ? a : b;
  const LineSegment& shorter = a_longer ? b : a;
  if (std::abs(longer.distance(shorter.middle())) > limits.distance) return false;
  return overlap(shorter, longer) >= limits.overlap;
}

bool onSameEdge(const LineSegment& line, const std::vector<LineSegment>& others,
                const SameEdgeLimits& limits) {
  return std::any_of(others.begin(), others.end(),
                     [&](const LineSegment& other) { return onSameEdge(line, other, limits); });
}

}  // namespace tet_line_tracker
