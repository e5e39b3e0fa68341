#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kernels/kernels.h"

namespace tet_line_tracker {

/// What an image says about the steps that can mean an edge in it.
struct ImageLevels {
  /// Standard deviation of one gradient component where the image holds nothing but noise, seen in its
  /// flattest part; near 0 for an image without noise.
  float noise{0.0F};
  float gray{0.0F};  ///< mean, 0..255
};

/// Gradient of a lightly smoothed gray image in 16-bit integers. Buffers are kept from image to image.
class GradientImage {
 public:
  /// A step of one gray level gives this at its place, along the axis it crosses.
  static constexpr int kPerGrayLevel = 48;
  /// Rows and columns at each border without a gradient; all values there are 0.
  static constexpr int kBorder = 2;
  /// Smallest image side with a gradient.
  static constexpr int kMinSide = 2 * kBorder + 1;

  /// Takes a new image (8-bit, one channel, both sides at least kMinSide).
  void compute(const cv::Mat& gray);

  /// Noise and brightness, estimated from a sample of the rows. `gray`: the image of compute().
  ImageLevels levels(const cv::Mat& gray) const;

  int width() const { return width_; }
  int height() const { return height_; }
  /// Elements from row to row in the arrays below.
  std::ptrdiff_t stride() const { return stride_; }
  const kernels::Gradient* gradient() const { return gradient_.data(); }
  /// |dx| + |dy| without its bits kernels::kFlags, which are free for marks until the next image.
  const std::int16_t* magnitude() const { return magnitude_.data(); }
  std::int16_t* magnitude() { return magnitude_.data(); }

 private:
  int width_{0};
  int height_{0};
  std::ptrdiff_t stride_{0};
  std::vector<kernels::Gradient> gradient_;
  std::vector<std::int16_t> magnitude_;
  std::vector<std::int16_t> smooth_, slope_;  // scratch of one row
};

}  // namespace tet_line_tracker
