#include "detection/fld_detector.h"

#ifdef TET_HAVE_XIMGPROC

#include <algorithm>
#include <cmath>

#include "geometry/clamp.h"

namespace tet_line_tracker {

namespace {

// Canny and the split into pieces need room.
constexpr int kMinSide = 16;

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

void FldDetector::find(const cv::Mat& gray, float min_length, const DetectionHints& /*hints*/,
                       std::vector<LineSegment>& lines) {
  if (gray.cols < kMinSide || gray.rows < kMinSide) return;
  // 10 px is OpenCV's default, below which the pieces are mostly noise.
  const int length_threshold = std::max(10, static_cast<int>(std::floor(min_length)));
  if (!detector_ || length_threshold != length_threshold_) {
    detector_ = cv::ximgproc::createFastLineDetector(length_threshold);
    length_threshold_ = length_threshold;
  }
  detector_->detect(gray, found_);
  for (const cv::Vec4f& found : found_) {
    LineSegment line{{found[0], found[1]}, {found[2], found[3]}};
    if (!(line.length() > 0.0F)) continue;
    if (leftMinusRight(gray, line) < 0) std::swap(line.start, line.end);
    lines.push_back(line);
  }
}

}  // namespace tet_line_tracker

#endif
