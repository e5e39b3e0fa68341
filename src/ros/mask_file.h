#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// The picture at `path` as a mask: 255 where its gray value is 128 or more, 0 elsewhere. Empty when the path
/// is; throws std::invalid_argument when there is no picture that can be read.
cv::Mat readMask(const std::string& path);

/// A sentence when a mask does not have the size of the images [px]; empty when it has, or when it is empty.
std::string maskComplaint(const cv::Mat& mask, int width, int height);

}  // namespace tet_line_tracker
