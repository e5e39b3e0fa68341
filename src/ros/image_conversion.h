#pragma once

#include <string>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// 8-bit gray view of an image message. mono8 and 8UC1 share the memory of `image`, which must outlive the
/// result and must not be written to; every other encoding gives a copy. mono16 and 16UC1 become
/// value * mono16_scale, rounded and saturated; bgr8, rgb8, bgra8, rgba8, bayer_*8 and yuv422 are converted
/// by cv_bridge. Throws std::invalid_argument with one sentence for another encoding, and for a message whose
/// size, step or data do not fit together.
cv::Mat toGray(const sensor_msgs::Image& image, double mono16_scale);

/// What the node and track_bag make of an image message: one that cannot be read is dropped and counted, and
/// the stream goes on.
struct GrayImage {
  cv::Mat gray;         ///< as of toGray(); empty: drop the image
  std::string problem;  ///< why it is dropped; empty when it is not
};
GrayImage readGray(const sensor_msgs::Image& image, double mono16_scale);

}  // namespace tet_line_tracker
