#pragma once

#include <cmath>
#include <memory>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

// Models without the test of plausibility that makeCameraModel() makes. Each throws std::invalid_argument
// when the number of coefficients does not fit the model, or one of them is not supported.

/// Chooses by the name of the distortion model; throws std::invalid_argument when it is not known.
std::shared_ptr<const CameraModel> makeUncheckedCameraModel(const CameraCalibration& calibration);

/// "plumb_bob" (k1 k2 p1 p2 [k3]) and "rational_polynomial" (k1 k2 p1 p2 k3 k4 k5 k6).
std::shared_ptr<const CameraModel> makePinholeModel(const CameraCalibration& calibration);
/// "equidistant" (k1 k2 k3 k4, Kannala-Brandt).
std::shared_ptr<const CameraModel> makeEquidistantModel(const CameraCalibration& calibration);
/// "mei" (xi k1 k2 p1 p2), the unified model of Mei and Rives, also called omnidirectional.
std::shared_ptr<const CameraModel> makeMeiModel(const CameraCalibration& calibration);

/// Mean of both focal lengths [px].
inline double meanFocal(const CameraCalibration& calibration) {
  return 0.5 * (calibration.fx + std::abs(calibration.fy));
}

}  // namespace tet_line_tracker
