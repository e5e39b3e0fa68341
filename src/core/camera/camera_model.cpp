#include "tet_line_tracker/camera/camera_model.h"

#include <stdexcept>

#include <Eigen/Geometry>

#include "camera/camera_models.h"

namespace tet_line_tracker {

std::optional<Eigen::Vector2d> CameraModel::normalize(const Eigen::Vector2d& pixel) const {
  const std::optional<Eigen::Vector3d> ray = unproject(pixel);
  // Written so that NaN fails.
  if (!ray || !(ray->z() >= kMinForward)) return std::nullopt;
  return ray->hnormalized();
}

std::shared_ptr<const CameraModel> makeUncheckedCameraModel(const CameraCalibration& calibration) {
  const std::string& model = calibration.model;
  if (model == "plumb_bob" || model == "rational_polynomial") return makePinholeModel(calibration);
  if (model.empty() && calibration.distortion.empty()) return makePinholeModel(calibration);
  if (model == "equidistant") return makeEquidistantModel(calibration);
  if (model == "mei") return makeMeiModel(calibration);
  throw std::invalid_argument("distortion model \"" + model +
                              "\" is not known; known: plumb_bob, rational_polynomial, equidistant, mei");
}

std::shared_ptr<const CameraModel> makeCameraModel(const CameraCalibration& calibration) {
  std::string sentences;
  for (const std::string& sentence : check(calibration)) {
    sentences += (sentences.empty() ? "calibration: " : "; ") + sentence;
  }
  if (!sentences.empty()) throw std::invalid_argument(sentences);
  return makeUncheckedCameraModel(calibration);
}

}  // namespace tet_line_tracker
