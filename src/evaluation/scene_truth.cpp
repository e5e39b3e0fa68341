#include "scene_truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {
namespace {

// How far beside the line the two sides are looked at [px]: clear of the edge itself, and of half a pixel
// that a detector may be off.
constexpr double kBesideLine = 1.5;
// Something must stand clearly before a point to hide it: the point may lie a little beside its surface.
constexpr double kHiddenBy = 0.02;          // [m]
constexpr double kHiddenByRelative = 0.01;  // of the distance
constexpr double kOnSurface = 0.002;        // for points exactly on theirs [m]

}  // namespace

SceneTruth::SceneTruth(SceneGeometry scene, PoseTrack world_from_camera,
                       std::shared_ptr<const CameraModel> camera)
    : scene_(std::move(scene)), world_from_camera_(std::move(world_from_camera)), camera_(std::move(camera)) {
  moving_.resize(scene_.bodies().size());
  for (const Rectangle& rectangle : scene_.rectangles()) {
    auto& screens = rectangle.body < 0 ? still_ : moving_[static_cast<std::size_t>(rectangle.body)];
    screens.push_back(screenOf(rectangle));
  }
}

SceneTruth::Screen SceneTruth::screenOf(const Rectangle& rectangle) {
  Screen screen;
  screen.corner = rectangle.origin;
  screen.across = rectangle.u_axis / rectangle.width;
  screen.up = rectangle.v_axis / rectangle.height;
  screen.normal = screen.across.cross(screen.up);
  return screen;
}

bool SceneTruth::standsInTheWay(const Screen& screen, const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                                double until) {
  const Eigen::Vector3d to_corner = screen.corner - from;
  const double reach = screen.normal.dot(to_corner) / screen.normal.dot(way);
  if (!(reach > 0.0 && reach < until)) return false;
  const Eigen::Vector3d offset = reach * way - to_corner;
  const double across = screen.across.dot(offset);
  const double up = screen.up.dot(offset);
  return across >= 0.0 && across <= 1.0 && up >= 0.0 && up <= 1.0;
}

bool SceneTruth::hidden(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double until,
                        std::int64_t stamp_ns) const {
  const auto anyHides = [until](const std::vector<Screen>& screens, const Eigen::Vector3d& start,
                                const Eigen::Vector3d& way) {
    return std::any_of(screens.begin(), screens.end(),
                       [&](const Screen& screen) { return standsInTheWay(screen, start, way, until); });
  };
  const Eigen::Vector3d way = to - from;
  if (anyHides(still_, from, way)) return true;
  for (std::size_t body = 0; body < moving_.size(); ++body) {
    const Eigen::Isometry3d body_from_world = scene_.bodies()[body].worldFromBody(stamp_ns).inverse();
    if (anyHides(moving_[body], body_from_world * from, body_from_world.linear() * way)) return true;
  }
  return false;
}

std::array<std::optional<RayHit>, 2> SceneTruth::hitsBeside(const Eigen::Isometry3d& world_from_camera,
                                                            std::int64_t stamp_ns,
                                                            const Eigen::Vector2d& pixel,
                                                            const Eigen::Vector2d& normal) const {
  const auto hitOn = [&](double side) -> std::optional<RayHit> {
    const auto ray = camera_->unproject(pixel + side * kBesideLine * normal);
    if (!ray) return std::nullopt;
    return scene_.raycast(world_from_camera.translation(), world_from_camera.linear() * *ray, stamp_ns);
  };
  return {hitOn(-1.0), hitOn(1.0)};
}

std::optional<SurfaceKind> SceneTruth::kindAt(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                              const Eigen::Vector2d& normal) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  if (!pose) return std::nullopt;
  const auto [first, second] = hitsBeside(*pose, stamp_ns, pixel, normal);
  if (!first && !second) return std::nullopt;
  const auto kindOf = [&](const RayHit& hit) {
    return scene_.rectangles()[static_cast<std::size_t>(hit.point.surface)].kind;
  };
  const bool first_is_nearer = first && (!second || first->distance < second->distance);
  const SurfaceKind kind = kindOf(first_is_nearer ? *first : *second);
  const bool same = first && second && kindOf(*first) == kindOf(*second);
  const bool within = kind == SurfaceKind::kMirror || kind == SurfaceKind::kScreen;
  if (within && !same) return SurfaceKind::kSolid;
  if (kind == SurfaceKind::kRound && same) return SurfaceKind::kSolid;
  return kind;
}

std::optional<WorldPoint> SceneTruth::lift(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                           const Eigen::Vector2d& normal) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  const auto ray_in_camera = camera_->unproject(pixel);
  if (!pose || !ray_in_camera) return std::nullopt;

  std::optional<RayHit> nearer;
  for (const auto& hit : hitsBeside(*pose, stamp_ns, pixel, normal)) {
    if (hit && (!nearer || hit->distance < nearer->distance)) nearer = hit;
  }
  if (!nearer) return std::nullopt;

  // The line's own ray meets the plane of the nearer surface, which goes on beyond the edge: no bias from
  // having looked beside the line.
  const auto corner = [&](double u, double v) {
    return scene_.pointAt({nearer->point.surface, {u, v}}, stamp_ns);
  };
  const Eigen::Vector3d origin = corner(0.0, 0.0);
  Eigen::Matrix3d system;
  system.col(0) = corner(1.0, 0.0) - origin;
  system.col(1) = corner(0.0, 1.0) - origin;
  system.col(2) = -(pose->linear() * *ray_in_camera);
  // A ray that grazes the plane meets it anywhere.
  if (std::abs(system.determinant()) < 1e-6) return std::nullopt;
  const Eigen::Vector3d solution = system.inverse() * (pose->translation() - origin);
  if (solution.z() <= 0.0) return std::nullopt;
  return WorldPoint{nearer->point.surface, {solution.x(), solution.y(), 0.0}};
}

std::optional<PointView> SceneTruth::view(const WorldPoint& point, std::int64_t stamp_ns) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  if (!pose) return std::nullopt;
  const Eigen::Vector3d in_world = scene_.pointAt({point.surface, point.position.head<2>()}, stamp_ns);
  const Eigen::Vector3d in_camera = pose->inverse() * in_world;
  const auto pixel = camera_->project(in_camera);
  if (!pixel) return std::nullopt;

  PointView view;
  view.pixel = *pixel;
  view.in_camera = in_camera;
  const CameraCalibration& calibration = camera_->calibration();
  view.in_picture =
      ImageBounds::ofImage(calibration.width, calibration.height).contains(pixel->cast<float>());
  const double until = 1.0 - kHiddenByRelative - kHiddenBy / in_camera.norm();
  view.hidden = view.in_picture && hidden(pose->translation(), in_world, until, stamp_ns);
  return view;
}

bool SceneTruth::isHidden(const Eigen::Vector3d& in_world, std::int64_t stamp_ns) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  if (!pose) return true;
  const double distance = (in_world - pose->translation()).norm();
  return hidden(pose->translation(), in_world, 1.0 - kOnSurface / distance, stamp_ns);
}

}  // namespace tet_line_tracker
