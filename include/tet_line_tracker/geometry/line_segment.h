#pragma once

#include <optional>

#include <Eigen/Core>

namespace tet_line_tracker {

/// A straight segment between two image points. Plain value; start and end are never swapped silently.
/// Pixels: x right, y down, (0, 0) is the centre of the top-left pixel.
struct LineSegment {
  Eigen::Vector2f start{Eigen::Vector2f::Zero()};  ///< [px]
  Eigen::Vector2f end{Eigen::Vector2f::Zero()};    ///< [px]

  /// [px]; 0 for a point.
  float length() const { return (end - start).norm(); }
  Eigen::Vector2f middle() const { return 0.5F * (start + end); }
  /// Point at `fraction` of the way from start (0) to end (1) [px].
  Eigen::Vector2f at(float fraction) const { return start + fraction * (end - start); }
  /// Unit vector from start to end. Precondition: length() > 0.
  Eigen::Vector2f direction() const { return (end - start).normalized(); }
  /// Unit vector to the left of direction() on screen. Precondition: length() > 0.
  Eigen::Vector2f normal() const {
    const Eigen::Vector2f d = direction();
    return {d.y(), -d.x()};
  }
  /// Signed distance of `point` from the infinite line, positive to the left of direction() on screen [px].
  /// Precondition: length() > 0.
  float distance(const Eigen::Vector2f& point) const { return normal().dot(point - start); }
  /// Place of the foot of `point` along the line: 0 at start, length() at end [px]. Precondition: length() >
  /// 0.
  float along(const Eigen::Vector2f& point) const { return direction().dot(point - start); }
};

/// Angle between the directions of two segments, their roles of start and end respected [rad], 0..pi.
/// Precondition: both lengths > 0.
float angleBetween(const LineSegment& a, const LineSegment& b);

/// Share of `a` that lies beside `b`, seen along the direction of `b`, 0..1. Precondition: both lengths > 0.
float overlap(const LineSegment& a, const LineSegment& b);

/// Rectangle of an image in which endpoints may lie, borders included [px].
struct ImageBounds {
  float min_x{0.0F}, min_y{0.0F}, max_x{0.0F}, max_y{0.0F};

  /// All pixel centres of an image of `width` x `height` that are at least `margin` from its outermost
  /// centres.
  static ImageBounds ofImage(int width, int height, float margin = 0.0F) {
    return {margin, margin, static_cast<float>(width - 1) - margin, static_cast<float>(height - 1) - margin};
  }
  bool contains(const Eigen::Vector2f& p) const {
    return p.x() >= min_x && p.x() <= max_x && p.y() >= min_y && p.y() <= max_y;
  }
};

/// The part of `segment` inside `bounds`, start and end in their roles; nothing when no part lies inside.
std::optional<LineSegment> clip(const LineSegment& segment, const ImageBounds& bounds);

}  // namespace tet_line_tracker
