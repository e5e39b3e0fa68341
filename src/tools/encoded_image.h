#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// Decodes a picture (PNG, JPEG and what else OpenCV reads) with `flags` of cv::imread. Throws
/// std::invalid_argument with a sentence that begins behind the picture's name, as in "is cut off after 9
/// bytes": cut off, JPEG data of which the decoder says that they are corrupt, or no picture at all. Damage
/// that leaves valid JPEG code cannot be seen, as JPEG has no checksum. For one thread: what decoders print
/// to stderr is caught meanwhile.
cv::Mat decodePicture(const std::vector<std::uint8_t>& bytes, int flags);

}  // namespace tet_line_tracker
