#pragma once

#include <memory>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// `camera`, but said to bend no line: a tracker with it takes every line for straight in the raw image, and
/// still predicts and normalises with the true lens. nullptr stays nullptr.
std::shared_ptr<const CameraModel> asChordCamera(std::shared_ptr<const CameraModel> camera);

}  // namespace tet_line_tracker
