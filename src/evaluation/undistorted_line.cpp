#include "undistorted_line.h"

#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr double kStep = 1e-4;  // [rad], a few hundredths of a pixel: a tangent

Eigen::Vector2d leftOf(const Eigen::Vector2d& direction) {
  return Eigen::Vector2d(direction.y(), -direction.x()).normalized();
}

}  // namespace

std::optional<double> imageDistance(const CameraModel& camera, const Eigen::Vector3d& normal,
                                    const Eigen::Vector3d& ray) {
  const Eigen::Vector3d unit = ray.normalized();
  const Eigen::Vector3d foot = (unit - normal.dot(unit) * normal).normalized();
  const Eigen::Vector3d tangent = normal.cross(foot);
  const auto pixel = camera.project(unit);
  const auto before = camera.project(foot - kStep * tangent);
  const auto after = camera.project(foot + kStep * tangent);
  if (!pixel || !before || !after) return std::nullopt;
  return leftOf(*after - *before).dot(*pixel - 0.5 * (*before + *after));
}

UndistortedLine::UndistortedLine(const CameraModel& camera, const TrackedLine& line)
    : camera_(camera),
      chord_(line.segment),
      has_rays_(line.start_normalized.allFinite() && line.end_normalized.allFinite()),
      start_(line.start_normalized.homogeneous().normalized()),
      end_(line.end_normalized.homogeneous().normalized()),
      normal_(start_.cross(end_).normalized()) {}

std::optional<UndistortedLine::Sample> UndistortedLine::at(double fraction) const {
  if (!has_rays_) {
    const Eigen::Vector2d along = (chord_.end - chord_.start).cast<double>();
    return Sample{chord_.start.cast<double>() + fraction * along, leftOf(along)};
  }
  const Eigen::Vector3d ray = start_ + fraction * (end_ - start_);
  const Eigen::Vector3d step = kStep * ray.norm() * (end_ - start_).normalized();
  const auto pixel = camera_.project(ray);
  const auto before = camera_.project(ray - step);
  const auto after = camera_.project(ray + step);
  if (!pixel || !before || !after) return std::nullopt;
  return Sample{*pixel, leftOf(*after - *before)};
}

std::optional<double> UndistortedLine::distance(const Eigen::Vector2d& pixel,
                                                const Eigen::Vector3d& in_camera) const {
  if (has_rays_) return imageDistance(camera_, normal_, in_camera);
  const Eigen::Vector2d start = chord_.start.cast<double>();
  return leftOf(chord_.end.cast<double>() - start).dot(pixel - start);
}

}  // namespace tet_line_tracker
