#pragma once

#include <memory>
#include <vector>

#include "baseline_tracker.h"
#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// TET with OpenCV's parts: lines detected once, then cv::calcOpticalFlowPyrLK on both endpoints (7x7 window,
/// 3 levels, 10 iterations) and the paper's residual test; detection again when fewer than min_lines are
/// left.
class LkEndpoints : public BaselineTracker {
 public:
  LkEndpoints(const LineTrackerParameters& parameters, std::unique_ptr<LineDetector> detector);

 protected:
  void track(const cv::Mat& gray) override;
  void forget() override { pyramid_before_.clear(); }

 private:
  void flow();
  void addLines(const cv::Mat& gray);

  double max_residual_;
  std::unique_ptr<LineDetector> detector_;
  std::vector<cv::Mat> pyramid_before_, pyramid_;
  std::vector<cv::Point2f> points_before_, points_;
  std::vector<uchar> found_;
  std::vector<float> residuals_;
  std::vector<LineSegment> candidates_;
};

}  // namespace tet_line_tracker
