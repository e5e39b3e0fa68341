#include "tet_line_tracker/camera/camera_model.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "camera/camera_models.h"

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
  if (!ray || ray->z() < kMinForward) return std::nullopt;
  return ray->hnormalized();
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
