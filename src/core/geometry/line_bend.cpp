#include "tet_line_tracker/geometry/line_bend.h"

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
  const auto lastInside = [&](float beyond) {
    constexpr float kAccuracy = 0.005F;  // [px]
    float last = inside;
    while (std::abs(beyond - last) * curve.chord.length() > kAccuracy) {
      const float middle = 0.5F * (last + beyond);
      (bounds.contains(curve.at(middle)) ? last : beyond) = middle;
    }
    return curve.at(last);
  };
  LineSegment clipped = curve.chord;
  if (!start_inside) clipped.start = lastInside(0.0F);
  if (!end_inside) clipped.end = lastInside(1.0F);
  return clipped;
}

}  // namespace tet_line_tracker
