#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"

/// What the parts of a painted image share: places, sizes and text.

namespace tet_line_tracker {

/// Fractional bits of the drawing functions of OpenCV, so that lines lie where they were measured.
constexpr int kDrawingShift = 4;

/// Of what was lost; no age has it.
const cv::Scalar kLossColour(230, 120, 255);

cv::Point fixedPoint(const Eigen::Vector2f& point);

/// Thickness and text grow with the picture: 1 for a WVGA image (752x480).
double drawingScale(const cv::Mat& image);

/// [px], at least 1.
int drawingThickness(double pixels_at_wvga, const cv::Mat& image);

/// Extent of a text of drawText() [px].
cv::Size textExtent(const std::string& text, double size, const cv::Mat& image);

/// Text with a dark rim, readable on any ground. `origin`: its lower left corner [px].
void drawText(const std::string& text, cv::Point origin, double size, const cv::Scalar& colour, cv::Mat& bgr);

/// The line as pieces so short that the curve leaves them by less than a fixed-point step.
std::vector<cv::Point> fixedPoints(const LineCurve& line);

}  // namespace tet_line_tracker
