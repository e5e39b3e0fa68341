#pragma once

#include <memory>
#include <optional>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// The part of an image whose pixels can be normalised (CameraModel::normalize()): all of it for most lenses,
/// a disc for those that see more than 168 degrees. Taken to be convex. Const after construction.
class FieldOfView {
 public:
  /// Tries pixels along the border of `bounds`, in which all segments have to lie. Without a camera
  /// everything is in view.
  FieldOfView(std::shared_ptr<const CameraModel> camera, const ImageBounds& bounds);

  /// The part of `curve` that can be normalised, start and end in their roles; nothing when less than
  /// `min_length` [px] can. A line with both ends in view comes back as it is.
  std::optional<LineSegment> clip(const LineCurve& curve, float min_length) const;

  /// Whether a pixel within the bounds can be normalised.
  bool contains(const Eigen::Vector2f& pixel) const;

 private:
  std::shared_ptr<const CameraModel> camera_;  ///< none: all pixels within the bounds are in view
};

}  // namespace tet_line_tracker
