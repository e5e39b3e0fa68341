#include "detection/fld_detector.h"

#ifdef TET_HAVE_XIMGPROC

#include <algorithm>
#include <cmath>

#include "detection/brighter_side.h"

namespace tet_line_tracker {

namespace {

// Canny and the split into pieces need room.
constexpr int kMinSide = 16;

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
    turnBrighterSideLeft(gray, line);
    lines.push_back(line);
  }
}

}  // namespace tet_line_tracker

#endif
