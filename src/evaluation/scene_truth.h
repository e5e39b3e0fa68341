#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "pose_track.h"
#include "simulation/scene_geometry.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "truth.h"

namespace tet_line_tracker {

/// Exact truth of a simulated world. Surfaces are the scene's rectangles; positions are along their axes.
class SceneTruth : public Truth {
 public:
  /// `world_from_camera`: at least the poses of all images.
  SceneTruth(SceneGeometry scene, PoseTrack world_from_camera, std::shared_ptr<const CameraModel> camera);

  const CameraModel& camera() const override { return *camera_; }
  std::optional<WorldPoint> lift(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& normal) const override;
  std::optional<PointView> view(const WorldPoint& point, std::int64_t stamp_ns) const override;

  /// What a line shows at a pixel. On a mirror or a screen when both sides are on it; on something round when
  /// the line is its outline, not painted on it. Nothing where no surface is known.
  std::optional<SurfaceKind> kindAt(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                    const Eigen::Vector2d& normal) const;

  const std::vector<TrueEdge>& edges() const { return scene_.edges(); }
  std::optional<Eigen::Isometry3d> worldFromCamera(std::int64_t stamp_ns) const {
    return world_from_camera_.at(stamp_ns);
  }
  /// Something stands before a point that lies exactly on a surface of the world, an edge of it included.
  bool isHidden(const Eigen::Vector3d& in_world, std::int64_t stamp_ns) const;

 private:
  /// A rectangle in the frame of its body, made ready for the question whether it stands in a way.
  struct Screen {
    Eigen::Vector3d corner, normal;
    Eigen::Vector3d across, up;  ///< times the offset from the corner: 0..1 inside
  };
  static Screen screenOf(const Rectangle& rectangle);
  /// What is seen beside a line, on either side of it.
  std::array<std::optional<RayHit>, 2> hitsBeside(const Eigen::Isometry3d& world_from_camera,
                                                  std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                                  const Eigen::Vector2d& normal) const;
  static bool standsInTheWay(const Screen& screen, const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                             double until);
  /// `until`: share of the way that must be free.
  bool hidden(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double until,
              std::int64_t stamp_ns) const;

  std::vector<Screen> still_;                ///< rectangles that do not move
  std::vector<std::vector<Screen>> moving_;  ///< the others, by body
  SceneGeometry scene_;
  PoseTrack world_from_camera_;
  std::shared_ptr<const CameraModel> camera_;
};

}  // namespace tet_line_tracker
