#include "image/gradient_image.h"

#include <algorithm>
#include <array>

namespace tet_line_tracker {

void GradientImage::compute(const cv::Mat& gray) {
  if (gray.cols != width_ || gray.rows != height_) {
    width_ = gray.cols;
    height_ = gray.rows;
    stride_ = width_;
    const auto size = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
    // The borders are zero from here on: rows are only ever written inside.
    gradient_.assign(size, {0, 0});
    magnitude_.assign(size, 0);
    smooth_.assign(static_cast<std::size_t>(width_), 0);
    slope_.assign(static_cast<std::size_t>(width_), 0);
  }
  const auto gradientRow = kernels::active().gradientRow;
  for (int y = kBorder; y < height_ - kBorder; ++y) {
    const std::uint8_t* const rows[5] = {gray.ptr<uchar>(y - 2), gray.ptr<uchar>(y - 1), gray.ptr<uchar>(y),
                                         gray.ptr<uchar>(y + 1), gray.ptr<uchar>(y + 2)};
    const std::ptrdiff_t row = y * stride_;
    gradientRow(rows, width_, smooth_.data(), slope_.data(), gradient_.data() + row, magnitude_.data() + row);
  }
}

ImageLevels GradientImage::levels(const cv::Mat& gray) const {
  // Most images have flat parts, where only noise is left: the lowest fifth of the magnitudes comes from
  // there. For components of standard deviation 1, P(|dx| + |dy| < m) = erf(m / 2)^2, a fifth at m = 0.839.
  constexpr float kShare = 0.2F;
  constexpr float kMagnitudeAtShare = 0.839F;
  // Clipped black and white hide the noise and are left out, unless hardly anything else is there.
  constexpr int kMinUnclippedPercent = 25;
  constexpr int kEveryRow = 8;
  constexpr int kBins = 4096;
  std::array<std::uint32_t, kBins> histogram{};
  std::uint32_t count = 0;
  std::uint32_t clipped = 0;
  std::uint64_t brightness = 0;
  for (int y = kBorder; y < height_ - kBorder; y += kEveryRow) {
    const std::int16_t* row = magnitude_.data() + y * stride_;
    const uchar* pixels = gray.ptr<uchar>(y);
    for (int x = kBorder; x < width_ - kBorder; ++x) {
      ++histogram[static_cast<std::size_t>(std::min<int>(row[x], kBins - 1))];
      brightness += pixels[x];
      clipped += row[x] == 0 && (pixels[x] == 0 || pixels[x] == 255) ? 1 : 0;
    }
    count += static_cast<std::uint32_t>(width_ - 2 * kBorder);
  }
  ImageLevels levels;
  levels.gray = static_cast<float>(brightness) / static_cast<float>(count);
  if (100 * (count - clipped) >= kMinUnclippedPercent * count) {
    count -= clipped;
    histogram[0] -= clipped;
  }
  const float wanted = kShare * static_cast<float>(count);
  float below = 0.0F;
  for (int m = 0; m < kBins; ++m) {
    const auto here = static_cast<float>(histogram[static_cast<std::size_t>(m)]);
    if (below + here >= wanted) {
      levels.noise = (static_cast<float>(m) + (wanted - below) / here) / kMagnitudeAtShare;
      return levels;
    }
    below += here;
  }
  levels.noise = static_cast<float>(kBins) / kMagnitudeAtShare;
  return levels;
}

}  // namespace tet_line_tracker
