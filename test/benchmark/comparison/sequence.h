#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Images of one camera at 20 Hz, played forth and back for as long as somebody looks: its motion never
/// jumps.
class Sequence {
 public:
  /// PNG images of a folder, in the order of their names. Throws std::runtime_error when it has none.
  static Sequence ofFolder(const std::string& folder);
  /// `count` images of the simulated flight `motion`.
  static Sequence simulated(const std::string& motion, int count);

  /// Image `i` of the endless stream, and its stamp [ns].
  const cv::Mat& image(std::size_t i) const;
  static std::int64_t stamp(std::size_t i) { return 1000000000000 + 50000000 * static_cast<std::int64_t>(i); }
  /// Images before it turns back.
  std::size_t size() const { return images_.size(); }
  const std::string& name() const { return name_; }

  /// The same scaled to another size.
  Sequence resized(cv::Size size) const;
  /// Lens of EuRoC's cam0, which the simulated camera has too, for images of this size.
  std::shared_ptr<const CameraModel> camera() const;

 private:
  std::string name_;
  std::vector<cv::Mat> images_;
};

}  // namespace tet_line_tracker
