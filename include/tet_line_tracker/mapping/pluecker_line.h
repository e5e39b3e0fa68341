#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tet_line_tracker {

/// An infinite line in space, in Pluecker coordinates: all x with x cross `direction` = `moment`.
struct PlueckerLine {
  Eigen::Vector3d direction{Eigen::Vector3d::UnitX()};  ///< unit vector
  Eigen::Vector3d moment{Eigen::Vector3d::Zero()};  ///< normal to direction; its length is the distance from
                                                    ///< the origin [m]

  static PlueckerLine through(const Eigen::Vector3d& point, const Eigen::Vector3d& unit_direction) {
    return {unit_direction, point.cross(unit_direction)};
  }
  /// The point nearest to the origin [m].
  Eigen::Vector3d foot() const { return direction.cross(moment); }
  /// Normal of the plane through `centre` and the line; its length is their distance [m].
  Eigen::Vector3d planeThrough(const Eigen::Vector3d& centre) const {
    return moment - centre.cross(direction);
  }
  /// The line after a small step in the orthonormal representation of Bartoli and Sturm: three angles turn
  /// the frame (moment, direction, their normal), the fourth trades distance for direction. Four numbers,
  /// none of them special. Precondition: moment is not 0.
  PlueckerLine moved(const Eigen::Vector4d& step) const;
  /// Derivatives of moment (rows 0..2) and direction (rows 3..5) by that step at 0, up to the common scale of
  /// both, which means nothing.
  Eigen::Matrix<double, 6, 4> derivatives() const;
};

/// What one image says of a line.
struct LineView {
  Eigen::Vector3d centre;     ///< of the camera [m]
  Eigen::Vector3d start_ray;  ///< unit vector from the camera to the start, in the axes of the world
  Eigen::Vector3d end_ray;
  /// Times the angles of both rays across the line: independent, with a standard deviation of 1 [1/rad].
  Eigen::Matrix2d whitening;
  double px_angle;  ///< angle of one pixel at this place of the image [rad]

  /// Unit normal of the plane through camera and line.
  Eigen::Vector3d plane() const { return start_ray.cross(end_ray).normalized(); }
};

/// A line in space as several views see it.
struct LineEstimate {
  PlueckerLine line;
  Eigen::Matrix4d covariance;    ///< of the step of PlueckerLine::moved(), from the covariances of the views
  std::vector<double> error_px;  ///< of each view: mean angle between its two rays and the line's plane [px]
};

/// The line in which two viewing planes meet; nothing when the cameras see the same plane.
std::optional<PlueckerLine> intersect(const LineView& a, const LineView& b);

/// The line that fits all views best, weighted by their covariances with a Huber loss, by Levenberg-Marquardt
/// from `initial`. Precondition: at least two views. Nothing when the views do not determine a line.
std::optional<LineEstimate> refine(const PlueckerLine& initial, const std::vector<LineView>& views);

}  // namespace tet_line_tracker
