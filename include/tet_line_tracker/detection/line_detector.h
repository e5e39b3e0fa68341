#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// What is known of an image before lines are detected in it.
struct DetectionHints {
  cv::Mat mask;  ///< 8-bit, size of the image: lines only where it is not zero; empty: everywhere
  std::vector<LineCurve> tracked;  ///< lines that need not be found again; a detector may do so nevertheless
  const LensBend* lens{nullptr};  ///< a detector may follow lines as the lens bends them; nullptr: not at all
  std::size_t enough{std::numeric_limits<std::size_t>::max()};  ///< a detector may stop at so many lines
};

/// Finds straight segments in one gray image. Not thread-safe: buffers are kept from call to call.
class LineDetector {
 public:
  virtual ~LineDetector() = default;

  /// Name as in the parameter `detector`.
  virtual std::string name() const = 0;

  /// Replaces `lines` by the segments of `gray` (8-bit, one channel, any stride) that are at least
  /// `min_length` long [px] after clipping to the pixel centres of the image. The brighter side of every
  /// segment lies to the left of its direction() on screen, where normal() points. Longest first; the same
  /// image gives the same lines in the same order. Of lines that lie partly on the mask those are given that
  /// lie mostly where it is not zero. Throws std::invalid_argument when type or size do not fit; an empty
  /// image has no lines.
  void detect(const cv::Mat& gray, float min_length, std::vector<LineSegment>& lines,
              const DetectionHints& hints = DetectionHints());

 private:
  /// Appends segments to `lines`, brighter side to the left. `gray` and `hints` are of the promised type and
  /// size. Short, hidden and overhanging segments may be among them: detect() sees to these.
  virtual void find(const cv::Mat& gray, float min_length, const DetectionHints& hints,
                    std::vector<LineSegment>& lines) = 0;
};

/// Detectors that work with the OpenCV at hand, found by trying them (`edge`, our own, needs nothing of it):
/// cv::createLineSegmentDetector throws on
/// OpenCV 4.1.0 to 4.5.3. Best first.
std::vector<std::string> availableDetectors();

/// Detector by name; "auto" takes the first of `preferred` that is available. Throws std::invalid_argument
/// that names the detector, the OpenCV version and the detectors that do work.
std::unique_ptr<LineDetector> makeLineDetector(const std::string& name,
                                               const std::vector<std::string>& preferred = {"edge", "lsd",
                                                                                            "fld"});

}  // namespace tet_line_tracker
