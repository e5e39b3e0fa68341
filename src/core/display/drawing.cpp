#include "display/drawing.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "geometry/clamp.h"

namespace tet_line_tracker {

cv::Point fixedPoint(const Eigen::Vector2f& point) {
  constexpr float kScale = 1 << kDrawingShift;
  constexpr float kFarOutside = 1e6F;
  return {cvRound(clampOrLow(point.x() * kScale, -kFarOutside, kFarOutside)),
          cvRound(clampOrLow(point.y() * kScale, -kFarOutside, kFarOutside))};
}

double drawingScale(const cv::Mat& image) {
  return std::clamp(std::sqrt(image.cols * (image.rows / (752.0 * 480.0))), 0.5, 4.0);
}

int drawingThickness(double pixels_at_wvga, const cv::Mat& image) {
  return std::max(1, cvRound(pixels_at_wvga * drawingScale(image)));
}

cv::Size textExtent(const std::string& text, double size, const cv::Mat& image) {
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size * drawingScale(image), 1, nullptr);
}

void drawText(const std::string& text, cv::Point origin, double size, const cv::Scalar& colour,
              cv::Mat& bgr) {
  const double scale = size * drawingScale(bgr);
  cv::putText(bgr, text, origin, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(0),
              drawingThickness(2.5, bgr), cv::LINE_AA);
  cv::putText(bgr, text, origin, cv::FONT_HERSHEY_SIMPLEX, scale, colour, drawingThickness(1, bgr),
              cv::LINE_AA);
}

std::vector<cv::Point> fixedPoints(const LineCurve& line) {
  constexpr float kPiece = 8.0F;  // [px]
  const float length = line.bend.isStraight() ? 0.0F : line.chord.length();
  const int pieces = 1 + static_cast<int>(clampOrLow(length / kPiece, 0.0F, 1e3F));
  std::vector<cv::Point> points{fixedPoint(line.chord.start)};
  for (int i = 1; i < pieces; ++i) {
    points.push_back(fixedPoint(line.at(static_cast<float>(i) / static_cast<float>(pieces))));
  }
  points.push_back(fixedPoint(line.chord.end));
  return points;
}

}  // namespace tet_line_tracker
