#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tet_line_tracker/parameters/parameters.h"
#include "tet_line_tracker/tracking/frame_sequence.h"
#include "tet_line_tracker/tracking/line_front_end.h"

namespace tet_line_tracker {

/// Another front end to compare LineTracker with. Of its parameters those of detection and stream are used,
/// but for `detector`: each baseline is made with its own. In the statistics, flow_ms is the time of matching
/// or flow, refine_ms that of describing lines, undistort_ms with that of remapping.
class BaselineTracker : public LineFrontEnd {
 public:
  void setCamera(std::shared_ptr<const CameraModel> camera) override { camera_ = std::move(camera); }
  FrameResult process(const cv::Mat& gray, std::int64_t stamp_ns) override;
  std::size_t reset() override { return frames_.reset(); }

 protected:
  explicit BaselineTracker(const LineTrackerParameters& parameters);

  /// Turns the lines of the image before, in frame().lines, into those of `gray`; fills in the counts, the
  /// times of the stages and `detected`.
  virtual void track(const cv::Mat& gray) = 0;
  /// Forgets what was kept besides frame().lines.
  virtual void forget() = 0;

  LineFrame& frame() { return frames_.frame(); }
  const DetectionParameters& detection() const { return detection_; }
  const std::shared_ptr<const CameraModel>& camera() const { return camera_; }
  /// A line that is seen for the first time.
  TrackedLine newLine(const LineSegment& segment);

 private:
  DetectionParameters detection_;
  FrameSequence frames_;
  std::shared_ptr<const CameraModel> camera_;
  std::uint64_t next_id_{0};
};

/// Names of the baselines that work with this build and its OpenCV.
std::vector<std::string> baselineNames();

/// Baseline by name. Throws std::invalid_argument for an unknown one, and one that names the part when this
/// OpenCV lacks a part that it needs.
std::unique_ptr<BaselineTracker> makeBaselineTracker(const std::string& name,
                                                     const LineTrackerParameters& parameters);

}  // namespace tet_line_tracker
