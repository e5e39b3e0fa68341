#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// What real cameras do to a picture beyond a little blur and noise.
struct CameraEffects {
  bool response{false};         ///< gamma 1 / 2.2 with a shoulder, exposed for the highlights
  bool sharpening{false};       ///< unsharp mask: a halo along each edge
  bool jpeg{false};             ///< compressed in the camera, quality 50
  bool vignette{false};         ///< a quarter of the light in the corners, instead of two thirds
  bool hot_pixels{false};       ///< one pixel in 2500 is always white or black
  bool defocus{false};          ///< blur of 1.5 px instead of 0.5 px
  bool skewed_blur{false};      ///< coma: a point has a tail to one side
  bool rolling_shutter{false};  ///< rows are exposed one after the other, kReadoutSeconds from first to last

  static constexpr double kReadoutSeconds = 0.016;
  /// Of the light that falls on the sensor, so that the response curve ends at the same mean.
  double exposureFactor() const { return response ? 0.42 : 1.0; }
  std::string text() const;  ///< as parseCameraEffects() reads it
};

/// Names of the effects, in the order of CameraEffects.
std::vector<std::string> cameraEffectNames();

/// Reads "none", "all" or a comma-separated list of names. Throws std::invalid_argument for others.
CameraEffects parseCameraEffects(const std::string& text);

/// The tail of skewed_blur over light (CV_32FC1). The middle of the light of a point stays where it is.
void addTail(cv::Mat& light);

/// What the camera makes of its raw gray levels (CV_32FC1): stuck pixels, response, sharpening, 8 bits, JPEG.
/// `camera_seed` says which pixels are stuck.
cv::Mat develop(const CameraEffects& effects, const cv::Mat& raw, std::uint64_t camera_seed);

}  // namespace tet_line_tracker
