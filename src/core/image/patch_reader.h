#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "geometry/clamp.h"
#include "kernels/kernels.h"

namespace tet_line_tracker {

/// Finds square patches around sub-pixel points of 8-bit images for the kernels. Pixels beyond the border
/// repeat the outermost one. Holds the buffer for that; cheap to make on the stack.
class PatchReader {
 public:
  explicit PatchReader(const kernels::PatchShape& shape) : shape_(shape) {}

  /// The patch around `centre` [px]; valid until the next call.
  kernels::PatchPlace patch(const cv::Mat& image, const Eigen::Vector2f& centre) {
    return place(image, centre, shape_.side);
  }
  /// The same with a rim of one pixel, as a template needs it.
  kernels::PatchPlace patchWithRim(const cv::Mat& image, const Eigen::Vector2f& centre) {
    return place(image, centre, shape_.side + 2);
  }

 private:
  static constexpr int kMaxColumns = 3 * kernels::kLanes + 3;
  static constexpr int kMaxRows = kernels::kMaxPatchSide + 3;

  kernels::PatchPlace place(const cv::Mat& image, const Eigen::Vector2f& centre, int side) {
    // Far outside the whole patch is border anyway; the bounds keep the conversion to int defined, also of
    // NaN. Truncation of a positive number instead of std::floor, which is slow without SSE4.
    constexpr int kShift = 1 << 12;
    const float half = 0.5F * static_cast<float>(side - 1);
    const float left = clampOrLow(centre.x() - half, -static_cast<float>(kShift), 1e6F);
    const float top = clampOrLow(centre.y() - half, -static_cast<float>(kShift), 1e6F);
    const int x = static_cast<int>(left + static_cast<float>(kShift)) - kShift;
    const int y = static_cast<int>(top + static_cast<float>(kShift)) - kShift;
    kernels::PatchPlace place{};
    place.fraction_x = left - static_cast<float>(x);
    place.fraction_y = top - static_cast<float>(y);
    const int columns = shape_.vectors * kernels::kLanes + 3;
    const int rows = side + 1;
    if (x >= 0 && y >= 0 && x + columns <= image.cols && y + rows <= image.rows) {
      place.data = image.ptr<std::uint8_t>(y) + x;
      place.stride = static_cast<std::ptrdiff_t>(image.step[0]);
      return place;
    }
    for (int r = 0; r < rows; ++r) {
      const std::uint8_t* source = image.ptr<std::uint8_t>(std::clamp(y + r, 0, image.rows - 1));
      std::uint8_t* target = border_.data() + r * kMaxColumns;
      for (int c = 0; c < columns; ++c) target[c] = source[std::clamp(x + c, 0, image.cols - 1)];
    }
    place.data = border_.data();
    place.stride = kMaxColumns;
    return place;
  }

  kernels::PatchShape shape_;
  std::array<std::uint8_t, kMaxRows * kMaxColumns> border_;
};

}  // namespace tet_line_tracker
