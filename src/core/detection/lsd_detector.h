#pragma once

#include <opencv2/imgproc.hpp>

#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// cv::createLineSegmentDetector with its default settings (von Gioi et al., LSD). The constructor lets
/// cv::Exception through where OpenCV ships without it (4.1.0 to 4.5.3).
class LsdDetector : public LineDetector {
 public:
  LsdDetector();
  std::string name() const override { return "lsd"; }

 private:
  void find(const cv::Mat& gray, float min_length, const DetectionHints& hints,
            std::vector<LineSegment>& lines) override;

  cv::Ptr<cv::LineSegmentDetector> detector_;
  std::vector<cv::Vec4f> found_;
};

}  // namespace tet_line_tracker
