#include "tet_line_tracker/camera_model.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "camera_models.h"

namespace tet_line_tracker {
namespace {

void requireFinite(double value, const std::string& field) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument("calibration: " + field + " is " + std::to_string(value) +
                                ", needs a finite number");
  }
}

}  // namespace

std::optional<Eigen::Vector2d> CameraModel::normalize(const Eigen::Vector2d& pixel) const {
  const std::optional<Eigen::Vector3d> ray = unproject(pixel);
  // Rays this close to the plane z = 0 meet z = 1 a thousand units out: of no use to an estimator.
  if (!ray || ray->z() < 1e-3) return std::nullopt;
  return ray->hnormalized();
}

std::optional<NormalizedSegment> normalizeSegment(const CameraModel& camera, const LineSegment& segment) {
  const std::optional<Eigen::Vector3d> start = camera.unproject(segment.start.cast<double>());
  const std::optional<Eigen::Vector3d> end = camera.unproject(segment.end.cast<double>());
  if (!start || !end) return std::nullopt;
  const bool start_in_front = start->z() >= kMinForward;
  const bool end_in_front = end->z() >= kMinForward;
  if (start_in_front && end_in_front) {
    return NormalizedSegment{start->hnormalized(), end->hnormalized(), false};
  }
  if (!start_in_front && !end_in_front) return std::nullopt;

  // The line in space is seen along the arc between the two rays, in the plane that both span: the arc is cut
  // where it leaves the front, so that the viewing plane, which is what a line measures, stays as it was.
  const Eigen::Vector3d front = start_in_front ? *start : *end;
  const Eigen::Vector3d back = start_in_front ? *end : *start;
  const Eigen::Vector3d normal = front.cross(back);
  const std::optional<Eigen::Vector3d> middle = camera.unproject(segment.middle().cast<double>());
  // An arc of more than half a turn, or no plane at all: which way the line runs cannot be said.
  if (!middle || normal.norm() < 1e-9 || front.cross(*middle).dot(normal) <= 0.0) return std::nullopt;
  const Eigen::Vector3d across = normal.normalized().cross(front);
  // z along the arc is amplitude * cos(angle - highest); it falls through kMinForward exactly once.
  const double amplitude = std::hypot(front.z(), across.z());
  const double angle = std::atan2(across.z(), front.z()) + std::acos(kMinForward / amplitude);
  const Eigen::Vector2d cut = (std::cos(angle) * front + std::sin(angle) * across).eval().hnormalized();
  if (start_in_front) return NormalizedSegment{start->hnormalized(), cut, true};
  return NormalizedSegment{cut, end->hnormalized(), true};
}

std::shared_ptr<const CameraModel> makeCameraModel(const CameraCalibration& calibration) {
  requireFinite(calibration.fx, "fx");
  requireFinite(calibration.fy, "fy");
  requireFinite(calibration.cx, "cx");
  requireFinite(calibration.cy, "cy");
  for (std::size_t i = 0; i < calibration.distortion.size(); ++i) {
    requireFinite(calibration.distortion[i], "distortion coefficient " + std::to_string(i));
  }
  if (calibration.fx == 0.0 || calibration.fy == 0.0) {
    throw std::invalid_argument("calibration: fx is " + std::to_string(calibration.fx) + " and fy is " +
                                std::to_string(calibration.fy) +
                                ", both must differ from 0 (0 means an uncalibrated camera)");
  }
  const std::string& model = calibration.model;
  if (model == "plumb_bob" || model == "rational_polynomial") return makePinholeModel(calibration);
  if (model.empty() && calibration.distortion.empty()) return makePinholeModel(calibration);
  if (model == "equidistant") return makeEquidistantModel(calibration);
  if (model == "mei") return makeMeiModel(calibration);
  throw std::invalid_argument("calibration: distortion model \"" + model +
                              "\" is not known; known: plumb_bob, rational_polynomial, equidistant, mei");
}

}  // namespace tet_line_tracker
