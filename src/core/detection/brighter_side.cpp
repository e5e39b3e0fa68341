#include "detection/brighter_side.h"

#include <cmath>
#include <utility>

#include "geometry/clamp.h"

namespace tet_line_tracker {

namespace {

/// Gray on the left minus gray on the right of the segment, summed over points along it.
int leftMinusRight(const cv::Mat& gray, const LineSegment& line) {
  constexpr int kPoints = 16;
  constexpr float kAside = 2.0F;  // [px], beyond the blur of a sharp edge
  const auto value = [&gray](const Eigen::Vector2f& p) {
    const int x = static_cast<int>(std::lround(clampOrLow(p.x(), 0.0F, static_cast<float>(gray.cols - 1))));
    const int y = static_cast<int>(std::lround(clampOrLow(p.y(), 0.0F, static_cast<float>(gray.rows - 1))));
    return static_cast<int>(gray.at<uchar>(y, x));
  };
  const Eigen::Vector2f aside = kAside * line.normal();
  int difference = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2f p = line.at((static_cast<float>(i) + 0.5F) / kPoints);
    difference += value(p + aside) - value(p - aside);
  }
  return difference;
}

}  // namespace

void turnBrighterSideLeft(const cv::Mat& gray, LineSegment& line) {
  if (leftMinusRight(gray, line) < 0) std::swap(line.start, line.end);
}

}  // namespace tet_line_tracker
