#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tet_line_tracker/tracking/stream_gate.h"

namespace tet_line_tracker {

/// The part that every LineFrontEnd shares: admits images by their stamps, numbers epochs and images, and
/// counts the dropped ones of an epoch.
class FrameSequence {
 public:
  explicit FrameSequence(const StreamParameters& parameters) : gate_(parameters) {}

  /// For the images to come.
  void setParameters(const StreamParameters& parameters) { gate_.setParameters(parameters); }

  /// Verdict for the next image. If it is accepted, frame() becomes its frame: numbered, with empty
  /// statistics and, at the start of an epoch, without lines. Throws std::invalid_argument unless `gray` is
  /// an 8-bit image of one channel.
  StreamVerdict begin(const cv::Mat& gray, std::int64_t stamp_ns);

  LineFrame& frame() { return frame_; }

  /// The next image starts a new epoch. Clears the lines of frame() and returns how many there were.
  std::size_t reset();

 private:
  StreamGate gate_;
  LineFrame frame_;
  bool any_epoch_{false};
  StreamGate::Dropped dropped_before_epoch_;
};

/// Sets the normalised endpoints of all lines; NaN where `camera` is nullptr or cannot normalise both.
void normalizeEndpoints(const CameraModel* camera, std::vector<TrackedLine>& lines);
/// The same for the lines alone whose ends are not normalised.
void normalizeMissingEndpoints(const CameraModel* camera, std::vector<TrackedLine>& lines);

}  // namespace tet_line_tracker
