#pragma once

#include <memory>

#include <Eigen/Core>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// Tells how a lens bends straight lines of space. Const once made; may be shared between threads.
///
/// The points between two rays lie in the plane of both (on the unit sphere, so that rays beyond 90 degrees
/// from the axis are no exception). Some of them, projected, fix the curve; between them it is off by less
/// than 0.01 px for lines of up to 400 px anywhere in the images of the lenses of lens_bend_test.
class LensBend {
 public:
  /// Lines whose offsets from the chord where the lens is asked are below this are straight [px]. Between
  /// these places offsets are up to 1.8 times larger, on lines that bend both ways.
  static constexpr float kMinSagitta = 0.005F;

  /// Without a camera, or with one that bends no line, every bend is straight.
  LensBend() = default;
  /// Looks at lines all over an image of this size [px].
  LensBend(std::shared_ptr<const CameraModel> camera, int width, int height);

  /// No line of the image is bent.
  bool isStraight() const { return camera_ == nullptr; }

  /// Bend of the line between two pixels of the raw image. Straight when one cannot be unprojected.
  LineBend between(const LineSegment& segment) const;
  /// The same for a segment whose ends appear at the rays `start` and `end` of the optical frame (of any
  /// length), to spare the undistortion.
  LineBend between(const LineSegment& segment, const Eigen::Vector3d& start,
                   const Eigen::Vector3d& end) const;
  LineCurve curve(const LineSegment& segment) const { return {segment, between(segment)}; }
  /// Where the line between two pixels is about `distance` px beyond `end`: on its curve, as long as the lens
  /// sees that far.
  Eigen::Vector2f beyond(const LineSegment& segment, float distance) const;

 private:
  std::shared_ptr<const CameraModel> camera_;
};

}  // namespace tet_line_tracker
