#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// A point on something in the world.
struct WorldPoint {
  int surface{-1};           ///< what it lies on; its meaning is the truth's own
  Eigen::Vector3d position;  ///< in the frame of the surface, which may move [m]
};

/// Where a world point is in an image.
struct PointView {
  Eigen::Vector2d pixel;      ///< [px], may lie outside the picture
  Eigen::Vector3d in_camera;  ///< the point in the optical frame [m]
  bool in_picture{false};     ///< the pixel lies inside the picture
  bool hidden{false};         ///< something nearer stands before it; only known inside the picture
};

/// What is known of the world in which lines were tracked. Const use may be shared between threads.
class Truth {
 public:
  virtual ~Truth() = default;

  virtual const CameraModel& camera() const = 0;

  /// The world point that a point of a line shows. Along an occlusion edge the two sides of a line belong to
  /// different surfaces; the edge is on the nearer one. `normal`: unit normal of the line at the pixel.
  /// Nothing where the truth is not known.
  virtual std::optional<WorldPoint> lift(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                         const Eigen::Vector2d& normal) const = 0;

  /// Where the point is in the image of another stamp; nothing when it is behind the camera, outside the
  /// lens model, or no pose is known.
  virtual std::optional<PointView> view(const WorldPoint& point, std::int64_t stamp_ns) const = 0;
};

}  // namespace tet_line_tracker
