#include "new_line_chooser.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tet_line_tracker {
namespace {

constexpr SameEdgeLimits kNewLineLimits{};

bool betterThan(const LineSegment& a, const LineSegment& b) {
  const auto key = [](const LineSegment& s) {
    return std::make_tuple(-s.length(), s.start.x(), s.start.y(), s.end.x(), s.end.y());
  };
  return key(a) < key(b);
}

}  // namespace

bool onSameEdge(const LineSegment& a, const LineSegment& b, const SameEdgeLimits& limits) {
  // The cheap tests first: nearly all pairs fail them.
  const Eigen::Vector2f u = a.end - a.start;
  const Eigen::Vector2f v = b.end - b.start;
  const float dot = u.dot(v);
  const float cross = u.x() * v.y() - u.y() * v.x();
  if (dot <= 0.0F || std::abs(cross) > std::tan(limits.angle) * dot) return false;
  const bool a_longer = u.squaredNorm() >= v.squaredNorm();
  const LineSegment& longer = a_longer ? a : b;
  const LineSegment& shorter = a_longer ? b : a;
  if (std::abs(longer.distance(shorter.middle())) > limits.distance) return false;
  return overlap(shorter, longer) >= limits.overlap;
}

void chooseNewLines(const std::vector<LineSegment>& tracked, std::size_t count,
                    std::vector<LineSegment>& candidates) {
  std::sort(candidates.begin(), candidates.end(), betterThan);
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < candidates.size() && chosen < count; ++i) {
    const LineSegment candidate = candidates[i];
    const auto taken = [&candidate](const LineSegment& other) {
      return onSameEdge(candidate, other, kNewLineLimits);
    };
    const auto chosen_end = candidates.begin() + static_cast<std::ptrdiff_t>(chosen);
    if (std::any_of(tracked.begin(), tracked.end(), taken)) continue;
    if (std::any_of(candidates.begin(), chosen_end, taken)) continue;
    candidates[chosen++] = candidate;
  }
  candidates.resize(chosen);
}

}  // namespace tet_line_tracker
