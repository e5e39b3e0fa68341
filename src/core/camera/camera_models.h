#pragma once

#include <memory>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

// One function per projection; makeCameraModel() has checked that all numbers are finite and the focal
// lengths differ from 0. Each throws std::invalid_argument that names what else is wrong with the
// calibration.

/// "plumb_bob" (k1 k2 p1 p2 [k3]) and "rational_polynomial" (k1 k2 p1 p2 k3 k4 k5 k6).
std::shared_ptr<const CameraModel> makePinholeModel(const CameraCalibration& calibration);
/// "equidistant" (k1 k2 k3 k4, Kannala-Brandt).
std::shared_ptr<const CameraModel> makeEquidistantModel(const CameraCalibration& calibration);
/// "mei" (xi k1 k2 p1 p2), the unified model of Mei and Rives, also called omnidirectional.
std::shared_ptr<const CameraModel> makeMeiModel(const CameraCalibration& calibration);

}  // namespace tet_line_tracker
