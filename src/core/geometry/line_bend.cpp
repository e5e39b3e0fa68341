#include "tet_line_tracker/geometry/line_bend.h"

#include "geometry/last_inside.h"

namespace tet_line_tracker {

std::optional<LineSegment> clip(const LineCurve& curve, const ImageBounds& bounds) {
  if (curve.bend.isStraight()) return clip(curve.chord, bounds);
  const bool start_inside = bounds.contains(curve.chord.start);
  const bool end_inside = bounds.contains(curve.chord.end);
  if (start_inside && end_inside) return curve.chord;
  float inside = start_inside ? 0.0F : 1.0F;
  if (!start_inside && !end_inside) {
    constexpr int kSteps = 16;
    int i = 1;
    while (i < kSteps && !bounds.contains(curve.at(static_cast<float>(i) / kSteps))) ++i;
    if (i == kSteps) return std::nullopt;
    inside = static_cast<float>(i) / kSteps;
  }
  const auto contains = [&bounds](const Eigen::Vector2f& point) { return bounds.contains(point); };
  LineSegment clipped = curve.chord;
  if (!start_inside) clipped.start = lastInside(curve, inside, 0.0F, contains);
  if (!end_inside) clipped.end = lastInside(curve, inside, 1.0F, contains);
  return clipped;
}

}  // namespace tet_line_tracker
