#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// The part of an image that drawLegend() takes; empty where the image is too small for one.
cv::Rect legendArea(const cv::Size& size);

/// What the image holds, in words.
std::string legendText(const LineFrame& frame);

/// How many lines were lost and why, in words; empty: none.
std::string lossText(const FrameStatistics& statistics);

/// Colours with their ages and both texts, along the lower border.
void drawLegend(const LineFrame& frame, cv::Mat& bgr);

}  // namespace tet_line_tracker
