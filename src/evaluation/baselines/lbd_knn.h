#pragma once

#include <memory>
#include <vector>

#include <opencv2/features2d.hpp>
#include <opencv2/line_descriptor.hpp>

#include "baseline_tracker.h"
#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// What the paper compares with (its detector is LSD): lines are detected in every image, those under
/// min_length dropped, a binary LBD descriptor taken of each of the others, and the two nearest of the image
/// before found by Hamming distance; the nearest is the same line when it is clearly nearer than the second.
class LbdKnn : public BaselineTracker {
 public:
  LbdKnn(const LineTrackerParameters& parameters, std::unique_ptr<LineDetector> detector);

 protected:
  void track(const cv::Mat& gray) override;
  void forget() override { descriptors_before_.release(); }
  /// Whether a detected line is used.
  virtual bool isWanted(const LineSegment&) const { return true; }

 private:
  /// For each line of this image its partner among those of the image before, or -1.
  std::vector<int> match(const cv::Mat& descriptors) const;

  std::unique_ptr<LineDetector> detector_;
  cv::Ptr<cv::line_descriptor::BinaryDescriptor> describer_;
  cv::BFMatcher matcher_;
  std::vector<LineSegment> segments_;
  cv::Mat descriptors_before_;  ///< of frame().lines of the image before, in their order
};

}  // namespace tet_line_tracker
