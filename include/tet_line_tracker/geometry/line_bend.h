#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// How far the image of a straight line in space leaves its chord, because the lens bends it: at fraction s
/// of the way from start to end, s (1 - s) (c0 + c1 u + ... + c10 u^10) px along the chord's normal(), with u
/// = 2 s - 1. All 0: the line is straight in the image.
struct LineBend {
  static constexpr std::size_t kTerms = 11;
  std::array<float, kTerms> c{};  ///< [px]
  std::size_t terms{kTerms};      ///< those from here on are 0

  bool isStraight() const { return c == std::array<float, kTerms>{}; }
  /// Distance of the curve from the chord at `fraction` [px].
  float offset(float fraction) const { return fraction * (1.0F - fraction) * factor(2.0F * fraction - 1.0F); }
  /// Derivative of offset() by the fraction [px].
  float slope(float fraction) const {
    const float u = 2.0F * fraction - 1.0F;
    float factor_slope = 0.0F;
    for (std::size_t k = terms - 1; k > 0; --k)
      factor_slope = factor_slope * u + 2.0F * static_cast<float>(k) * c[k];
    return -u * factor(u) + fraction * (1.0F - fraction) * factor_slope;
  }

 private:
  float factor(float u) const {
    float sum = 0.0F;
    for (std::size_t k = terms; k-- > 0;) sum = sum * u + c[k];
    return sum;
  }
};

/// The image of a straight line in space: its ends and the curve between them.
struct LineCurve {
  LineSegment chord;  ///< [px]
  LineBend bend;

  LineCurve() = default;
  /// A segment alone is straight.
  LineCurve(const LineSegment& segment, const LineBend& lens_bend = LineBend())
      : chord(segment), bend(lens_bend) {}

  /// Point of the curve at `fraction` of the way along the chord [px].
  Eigen::Vector2f at(float fraction) const {
    if (bend.isStraight()) return chord.at(fraction);
    return chord.at(fraction) + bend.offset(fraction) * chord.normal();
  }
  /// Signed distance of `point` from the curve along the chord's normal, positive to the left on screen [px].
  float distance(const Eigen::Vector2f& point) const {
    const float from_chord = chord.distance(point);
    if (bend.isStraight()) return from_chord;
    return from_chord - bend.offset(chord.along(point) / chord.length());
  }
};

/// The ends of the part of `curve` inside `bounds`, in their roles; nothing when no part lies inside. Ends
/// that are inside stay as they are, also where the curve leaves the bounds between them.
std::optional<LineSegment> clip(const LineCurve& curve, const ImageBounds& bounds);

}  // namespace tet_line_tracker
