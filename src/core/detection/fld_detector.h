#pragma once

#ifdef TET_HAVE_XIMGPROC

#include <opencv2/ximgproc.hpp>

#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// cv::ximgproc::createFastLineDetector (Lee et al., FLD): Canny edges split into straight pieces, without
/// sub-pixel position.
class FldDetector : public LineDetector {
 public:
  std::string name() const override { return "fld"; }

 private:
  void find(const cv::Mat& gray, float min_length, const DetectionHints& hints,
            std::vector<LineSegment>& lines) override;

  cv::Ptr<cv::ximgproc::FastLineDetector> detector_;
  int length_threshold_{0};  // of detector_ [px]
  std::vector<cv::Vec4f> found_;
};

}  // namespace tet_line_tracker

#endif
