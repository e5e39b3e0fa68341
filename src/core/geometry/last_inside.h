#pragma once

#include <cmath>

#include <Eigen/Core>

#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// The last point of `curve` that `contains` holds for, on the way from fraction `inside`, where it does, to
/// `beyond`, where it does not: to 0.005 px, or as exact as a float is on a line that leads far away.
template <class Contains>
Eigen::Vector2f lastInside(const LineCurve& curve, float inside, float beyond, const Contains& contains) {
  constexpr float kAccuracy = 0.005F;  // [px]
  while (std::abs(beyond - inside) * curve.chord.length() > kAccuracy) {
    const float middle = 0.5F * (inside + beyond);
    if (middle == inside || middle == beyond) break;
    (contains(curve.at(middle)) ? inside : beyond) = middle;
  }
  return curve.at(inside);
}

}  // namespace tet_line_tracker
