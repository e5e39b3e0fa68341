#include "edge_drawing_detector.h"

#if defined(TET_HAVE_XIMGPROC) && __has_include(<opencv2/ximgproc/edge_drawing.hpp>)

#include <string>
#include <vector>

#include <opencv2/ximgproc.hpp>

#include "detection/brighter_side.h"

namespace tet_line_tracker {
namespace {

// Chains and the check of lines by their number of false alarms need room.
constexpr int kMinSide = 16;

class EdgeDrawingDetector : public LineDetector {
 public:
  EdgeDrawingDetector() {
    // OpenCV's 20 and 0 give more lines, of which fewer are found again.
    detector_->params.GradientThresholdValue = 36;
    detector_->params.AnchorThresholdValue = 8;
  }
  std::string name() const override { return "edge_drawing"; }

 private:
  void find(const cv::Mat& gray, float /*min_length*/, const DetectionHints& /*hints*/,
            std::vector<LineSegment>& lines) override {
    if (gray.cols < kMinSide || gray.rows < kMinSide) return;
    // It reads the image without a regard for its stride.
    detector_->detectEdges(gray.isContinuous() ? gray : gray.clone());
    detector_->detectLines(found_);
    for (const cv::Vec4f& found : found_) {
      LineSegment line{{found[0], found[1]}, {found[2], found[3]}};
      if (!(line.length() > 0.0F)) continue;
      turnBrighterSideLeft(gray, line);
      lines.push_back(line);
    }
  }

  cv::Ptr<cv::ximgproc::EdgeDrawing> detector_{cv::ximgproc::createEdgeDrawing()};
  std::vector<cv::Vec4f> found_;
};

}  // namespace

std::unique_ptr<LineDetector> makeEdgeDrawingDetector() {
  return std::make_unique<EdgeDrawingDetector>();
}

}  // namespace tet_line_tracker

#else

namespace tet_line_tracker {

std::unique_ptr<LineDetector> makeEdgeDrawingDetector() {
  return nullptr;
}

}  // namespace tet_line_tracker

#endif
