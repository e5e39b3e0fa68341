#pragma once

#include <memory>

#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// cv::ximgproc::EdgeDrawing (Akinlar and Topal, EDLines): chains of edge pixels, split into straight pieces
/// that a least-squares line fits; gradient threshold 36, anchor threshold 8, else the default settings.
/// nullptr: this OpenCV has none, as 4.2 of Ubuntu 20.04.
std::unique_ptr<LineDetector> makeEdgeDrawingDetector();

}  // namespace tet_line_tracker
