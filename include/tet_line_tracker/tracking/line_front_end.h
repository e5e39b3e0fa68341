#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tet_line_tracker/tracking/stream_gate.h"

namespace tet_line_tracker {

/// What a front end made of an image.
struct FrameResult {
  StreamVerdict verdict{StreamVerdict::kDropZero};
  const LineFrame* frame{nullptr};  ///< valid until the next call; nullptr: the image was dropped
};

/// Images in, lines with ids out. Not thread-safe; two front ends share nothing. The same images and
/// parameters give the same lines.
class LineFrontEnd {
 public:
  virtual ~LineFrontEnd() = default;

  /// Calibration for the normalised endpoints; nullptr: they are NaN. May change between images.
  virtual void setCamera(std::shared_ptr<const CameraModel> camera) = 0;

  /// Tracks the lines of the image before into `gray` (8-bit, one channel; not copied, not kept) with its
  /// stamp [ns]. The verdict says whether the image was used, started a new epoch, or why it was dropped.
  /// Throws std::invalid_argument for an image that is empty or not 8-bit gray.
  virtual FrameResult process(const cv::Mat& gray, std::int64_t stamp_ns) = 0;

  /// Forgets all tracks; the next image starts a new epoch. Returns the number of tracks that were dropped.
  virtual std::size_t reset() = 0;
};

}  // namespace tet_line_tracker
