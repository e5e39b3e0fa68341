#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// Gaussian pyramid of the paper (equation for I^j): each level is the one below, smoothed by the 3x3
/// binomial kernel and read at every second pixel. Pixel x of level j lies exactly on pixel 2x of level j -
/// 1, so coordinates scale by 1/2 without a shift. Sizes are rounded up; beyond the border the outermost
/// pixel is repeated. Level 0 is the image itself, referenced and not copied: it must outlive its use. The
/// buffers of the other levels are kept from build to build.
class ImagePyramid {
 public:
  /// `gray`: 8-bit, one channel, not empty. `levels`: images in the pyramid, `gray` included, at least 1;
  /// fewer are made when the image becomes smaller than kMinSide.
  void build(const cv::Mat& gray, int levels);

  int levels() const { return static_cast<int>(images_.size()); }
  const cv::Mat& level(int j) const { return images_[static_cast<std::size_t>(j)]; }
  /// Coordinates at level j = scale(j) * coordinates of the original image.
  static float scale(int j) { return 1.0F / static_cast<float>(1 << j); }

  static constexpr int kMinSide = 16;  ///< of a level [px]

 private:
  std::vector<cv::Mat> images_;
  std::vector<cv::Mat> buffers_;
  std::vector<std::uint16_t> row_;
};

}  // namespace tet_line_tracker
