#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <ros/time.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "output_file.h"
#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {

/// Throws std::runtime_error with one sentence when `path` does not end as a video that TrackVideo writes.
void checkVideoName(const std::string& path);

/// Images per second of a stream: by the median of its intervals, 1 to 240 Hz; 20 for a single image.
double imageRate(const std::vector<ros::Time>& stamps);

/// A video of images with their lines, as ~debug_image shows them: .mp4 (MPEG-4) or .avi (Motion JPEG).
/// Destroyed before close() it leaves no file.
class TrackVideo {
 public:
  TrackVideo(const std::string& path, double rate_hz);

  void setCamera(std::shared_ptr<const CameraModel> camera);
  /// Images of another size than the first one are scaled to its size. Throws std::runtime_error when there
  /// is no encoder.
  void add(const cv::Mat& gray, const LineFrame& frame);
  /// Gives the file its name. Throws std::runtime_error when not every image can be read again, as when the
  /// disk was full.
  void close();

 private:
  std::string ending_;
  double rate_hz_;
  TemporaryOutput output_;
  TrackPainter painter_;
  cv::VideoWriter writer_;
  cv::Size size_;
  cv::Mat picture_;
  std::size_t images_{0};
};

}  // namespace tet_line_tracker
