#include "raw_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../ros/camera_info.h"

namespace tet_line_tracker {
namespace {

constexpr double kMaxPiece = 64.0;   ///< longer ones are divided, whatever is seen of their bend [px]
constexpr double kMaxOffset = 0.02;  ///< of the middle of a piece from its chord [px]
constexpr int kMaxDivisions = 9;

/// An image point of a line and its ray.
struct RayPoint {
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;  ///< of unit length
};

/// Appends points between two of a line, so many that the line is straight from each to the next.
void divide(const CameraModel& camera, const RayPoint& from, const RayPoint& to, int divisions,
            std::vector<Eigen::Vector2d>& points) {
  // In the plane of both rays, also where they are beyond 90 degrees from the axis.
  const Eigen::Vector3d ray = (from.ray + to.ray).normalized();
  const std::optional<Eigen::Vector2d> pixel = camera.project(ray);
  if (!pixel || !pixel->allFinite()) return;
  const Eigen::Vector2d chord = to.pixel - from.pixel;
  const Eigen::Vector2d way = *pixel - from.pixel;
  const double length = chord.norm();
  const double twice_area = std::abs(chord.x() * way.y() - chord.y() * way.x());
  if (length < kMaxPiece && twice_area < kMaxOffset * length) return;
  const RayPoint middle{*pixel, ray};
  if (divisions < kMaxDivisions) divide(camera, from, middle, divisions + 1, points);
  points.push_back(*pixel);
  if (divisions < kMaxDivisions) divide(camera, middle, to, divisions + 1, points);
}

bool canProject(const sensor_msgs::CameraInfo& info) {
  return std::all_of(info.P.begin(), info.P.end(), [](double value) { return std::isfinite(value); }) &&
         info.P[0] != 0.0 && info.P[5] != 0.0;
}

}  // namespace

RawPicture::RawPicture(const sensor_msgs::CameraInfo& info, std::shared_ptr<const CameraModel> camera)
    : camera_(std::move(camera)),
      focal_(info.P[0], info.P[5]),
      centre_(info.P[2], info.P[6]),
      // rviz takes P[7] with the sign of an axis that points up.
      shift_(-info.P[3] / info.P[0], info.P[7] / info.P[5]),
      scale_(std::max(info.binning_x, 1U), std::max(info.binning_y, 1U)),
      offset_(info.roi.x_offset, info.roi.y_offset) {}

Eigen::Vector3d RawPicture::pointOver(const Eigen::Vector2d& pixel, double depth) const {
  // rviz lays the corner of the first pixel, not its middle, where P has (0, 0).
  const Eigen::Array2d in_full = (pixel.array() + 0.5) * scale_ + offset_;
  const Eigen::Array2d point = shift_ + depth * (in_full - centre_) / focal_;
  return {point.x(), point.y(), depth};
}

std::vector<Eigen::Vector2d> RawPicture::between(const Eigen::Vector2d& start,
                                                 const Eigen::Vector2d& end) const {
  if (!camera_->bendsLines()) return {};
  const std::optional<Eigen::Vector3d> from = camera_->unproject(start);
  const std::optional<Eigen::Vector3d> to = camera_->unproject(end);
  if (!from || !to) return {};
  std::vector<Eigen::Vector2d> points;
  divide(*camera_, {start, *from}, {end, *to}, 1, points);
  return points;
}

RawPictureChoice chooseRawPicture(const sensor_msgs::CameraInfo& info, std::uint32_t width,
                                  std::uint32_t height) {
  CameraChoice choice = chooseCamera(info, width, height);
  if (choice.camera == nullptr) return {nullptr, choice.problem};
  if (!canProject(info)) {
    return {nullptr, "P of camera_info is zero or not finite: the Camera display of rviz needs it"};
  }
  return {std::make_shared<const RawPicture>(info, std::move(choice.camera)), {}};
}

}  // namespace tet_line_tracker
