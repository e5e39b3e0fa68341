#pragma once

#include <cstdint>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/CompressedImage.h>
#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// What to make of the warnings of libjpeg, which it only prints.
enum class DecoderWarnings {
  kAreDamage,  ///< stderr is caught meanwhile: for programs that decode in one thread
  kArePrinted
};

/// Decodes a picture (PNG, JPEG and what else OpenCV reads) with `flags` of cv::imread. Throws
/// std::invalid_argument with a sentence that begins behind the picture's name, as in "is cut off after 9
/// bytes": cut off, JPEG data of which the decoder warns that they are corrupt, or no picture at all. Damage
/// that leaves valid JPEG code cannot be seen, as JPEG has no checksum.
cv::Mat decodePicture(const std::vector<std::uint8_t>& bytes, int flags,
                      DecoderWarnings warnings = DecoderWarnings::kAreDamage);

/// A compressed image with the encoding that the transport plugin `compressed` would give it: mono8, bgr8,
/// bgra8, mono16, or bayer_*8 where `format` says so. Throws std::invalid_argument with one sentence when it
/// cannot be decoded.
cv_bridge::CvImage decompress(const sensor_msgs::CompressedImage& message, DecoderWarnings warnings);

}  // namespace tet_line_tracker
