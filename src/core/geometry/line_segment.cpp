#include "tet_line_tracker/geometry/line_segment.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {

float angleBetween(const LineSegment& a, const LineSegment& b) {
  const Eigen::Vector2f u = a.direction();
  const Eigen::Vector2f v = b.direction();
  // Of doubles: atan2f differs between processors.
  const double cross = u.x() * v.y() - u.y() * v.x();
  const double dot = u.dot(v);
  return static_cast<float>(std::abs(std::atan2(cross, dot)));
}

float overlap(const LineSegment& a, const LineSegment& b) {
  const float first = b.along(a.start);
  const float second = b.along(a.end);
  const float low = std::max(0.0F, std::min(first, second));
  const float high = std::min(b.length(), std::max(first, second));
  const float spread = std::abs(second - first);
  if (spread <= 0.0F) return first >= 0.0F && first <= b.length() ? 1.0F : 0.0F;
  return std::clamp((high - low) / spread, 0.0F, 1.0F);
}

std::optional<LineSegment> clip(const LineSegment& segment, const ImageBounds& bounds) {
  // Liang-Barsky: the range of fractions along the segment that lies inside all four borders.
  const Eigen::Vector2f d = segment.end - segment.start;
  const float p[4] = {-d.x(), d.x(), -d.y(), d.y()};
  const float q[4] = {segment.start.x() - bounds.min_x, bounds.max_x - segment.start.x(),
                      segment.start.y() - bounds.min_y, bounds.max_y - segment.start.y()};
  float enter = 0.0F;
  float leave = 1.0F;
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0.0F) {
      if (q[i] < 0.0F) return std::nullopt;
    } else if (p[i] < 0.0F) {
      enter = std::max(enter, q[i] / p[i]);
    } else {
      leave = std::min(leave, q[i] / p[i]);
    }
  }
  if (enter > leave) return std::nullopt;
  // Rounding must not leave an endpoint a hair outside.
  const auto inside = [&bounds](const Eigen::Vector2f& point) -> Eigen::Vector2f {
    return {std::clamp(point.x(), bounds.min_x, bounds.max_x),
            std::clamp(point.y(), bounds.min_y, bounds.max_y)};
  };
  LineSegment clipped = segment;
  if (enter > 0.0F) clipped.start = inside(segment.at(enter));
  if (leave < 1.0F) clipped.end = inside(segment.at(leave));
  return clipped;
}

}  // namespace tet_line_tracker
