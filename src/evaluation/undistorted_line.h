#pragma once

#include <optional>

#include <Eigen/Core>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Signed distance of where `ray` appears from the image of the plane through the camera with unit `normal`
/// (a straight line of space), across that image, in pixels of the raw image. Nothing where the model ends.
std::optional<double> imageDistance(const CameraModel& camera, const Eigen::Vector3d& normal,
                                    const Eigen::Vector3d& ray);

/// A tracked line as the estimator gets it: straight between its undistorted ends, so a curve in the raw
/// image. Where these are NaN it is the chord of the raw image. The camera must outlive this.
class UndistortedLine {
 public:
  UndistortedLine(const CameraModel& camera, const TrackedLine& line);

  struct Sample {
    Eigen::Vector2d pixel;   ///< [px]
    Eigen::Vector2d normal;  ///< unit normal of the line at the pixel, to the left on screen
  };
  /// Point at `fraction` of the way from start to end; nothing where the model cannot project it.
  std::optional<Sample> at(double fraction) const;

  /// Signed distance across the infinite line of a point that appears at `pixel`, positive to the left on
  /// screen [px]. `in_camera`: the same point in the optical frame.
  std::optional<double> distance(const Eigen::Vector2d& pixel, const Eigen::Vector3d& in_camera) const;

 private:
  const CameraModel& camera_;
  LineSegment chord_;
  bool has_rays_;
  Eigen::Vector3d start_, end_;  ///< unit rays
  Eigen::Vector3d normal_;       // of the plane of both
};

}  // namespace tet_line_tracker
