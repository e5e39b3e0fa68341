#pragma once

#include <Eigen/Core>

#include "tet_line_tracker/motion/motion_prior.h"

namespace tet_line_tracker {

/// How deep both ends of a line lie, as far as their movement across the line has told: inverse depths (1 /
/// z) of start and end, in units of 1 / the camera's last step.
struct LineDepth {
  bool known{false};
  Eigen::Vector2d inverse{Eigen::Vector2d::Zero()};
  Eigen::Vector2d variance{Eigen::Vector2d::Zero()};
  double across{0.0};  ///< of a measured depth: movement across the line per inverse depth [on z = 1]

  /// The same in the unit of a step that is `ratio` times as long, less sure.
  LineDepth inUnitOf(double ratio) const;
};

/// A line in two images, its ends as rays of the optical frame.
struct LineStep {
  Eigen::Vector3d start_before, end_before;  ///< of the image before (z = 1 there), rotated to this one
  Eigen::Vector2d start_now, end_now;        ///< on z = 1
  bool valid() const { return start_before.allFinite() && start_now.allFinite() && end_now.allFinite(); }
};

/// Where the line's ends would be on z = 1, and how far they move across the line per inverse depth.
struct DepthSensitivity {
  Eigen::Vector2d across{Eigen::Vector2d::Zero()};  ///< of start and end [on z = 1 per inverse depth]
};
DepthSensitivity sensitivityOf(const LineStep& step, const Eigen::Vector2d& inverse,
                               const Eigen::Vector3d& translation);

/// Inverse depths at the ends of the image before by which the line moved as seen: the ray of an end, moved
/// by inverse depth * translation, lies in the plane of the line seen now. `sigma`: of the place across the
/// line [on z = 1].
LineDepth measureDepth(const LineStep& step, const Eigen::Vector3d& translation, double sigma);

/// A measured depth that puts the line behind the camera, or that is far from the expected one, where that is
/// `known` from earlier images: by more than `tolerance` of movement across the line [on z = 1], and by more
/// than four deviations.
bool contradicts(const LineDepth& measured, const LineDepth& expected, bool known, double tolerance);

/// Both estimates, weighted by their variances.
LineDepth fused(const LineDepth& expected, const LineDepth& measured);

/// `depth` of the ends before, for the ends now and as the camera sees them now.
LineDepth movedTo(const LineStep& step, const LineDepth& depth, const Eigen::Vector3d& translation);

}  // namespace tet_line_tracker
