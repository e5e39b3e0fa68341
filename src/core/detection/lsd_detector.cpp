#include "detection/lsd_detector.h"

namespace tet_line_tracker {

namespace {

// OpenCV samples the image at scale 0.8 with pixel centres at half-integers, takes gradients between 2x2
// pixels, and gives back (x' + 0.5) / 0.8 for the centre of such a block at x' + 0.5. The true place is
// (x' + 0.5 + 0.5) / 0.8 - 0.5.
constexpr float kCentreOffset = 0.5F / 0.8F - 0.5F;

// The detector reads a few pixels around each point, and smaller images hold no line anyway.
constexpr int kMinSide = 8;

}  // namespace

LsdDetector::LsdDetector() : detector_(cv::createLineSegmentDetector()) {}

void LsdDetector::find(const cv::Mat& gray, float /*min_length*/, const DetectionHints& /*hints*/,
                       std::vector<LineSegment>& lines) {
  if (gray.cols < kMinSide || gray.rows < kMinSide) return;
  detector_->detect(gray, found_);
  const Eigen::Vector2f offset(kCentreOffset, kCentreOffset);
  for (const cv::Vec4f& line : found_) {
    lines.push_back({Eigen::Vector2f(line[0], line[1]) + offset, Eigen::Vector2f(line[2], line[3]) + offset});
  }
}

}  // namespace tet_line_tracker
