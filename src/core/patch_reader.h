#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kernels/kernels.h"

namespace tet_line_tracker {

/// Reads square patches around sub-pixel points of 8-bit images. Pixels beyond the border repeat the
/// outermost one. Holds its buffers; cheap to make on the stack.
class PatchReader {
 public:
  static constexpr int kMaxSide = 23;

  explicit PatchReader(int side) : shape_(kernels::PatchShape::ofSide(side)) {
    // Vectors may look past the last row of a patch; what stands there is masked but must be a number.
    std::fill(patch_.begin() + shape_.floats(), patch_.begin() + shape_.floats() + kernels::kLanes, 0.0F);
  }

  /// Patch around `centre` [px]; valid until the next call.
  const float* read(const cv::Mat& image, const Eigen::Vector2f& centre) {
    kernels::active().readPatch(place(image, centre), shape_, patch_.data());
    return patch_.data();
  }

  /// Patch around `centre` less the template's mean, and its sums against the template; valid until the next
  /// call.
  const float* align(const cv::Mat& image, const Eigen::Vector2f& centre,
                     const kernels::PatchTemplate& reference, kernels::AlignmentSums* sums) {
    kernels::active().align(place(image, centre), shape_, reference, patch_.data(), sums);
    return patch_.data();
  }

 private:
  static constexpr int kMaxColumns = 3 * kernels::kLanes + 1;
  static constexpr int kMaxRows = kMaxSide + 1;

  kernels::PatchPlace place(const cv::Mat& image, const Eigen::Vector2f& centre) {
    // Far outside the whole patch is border anyway; the bounds keep the conversion to int defined.
    const float half = 0.5F * static_cast<float>(shape_.side - 1);
    const float left = std::clamp(centre.x() - half, -1e6F, 1e6F);
    const float top = std::clamp(centre.y() - half, -1e6F, 1e6F);
    const int x = static_cast<int>(std::floor(left));
    const int y = static_cast<int>(std::floor(top));
    kernels::PatchPlace place{};
    place.fraction_x = left - static_cast<float>(x);
    place.fraction_y = top - static_cast<float>(y);
    const int columns = shape_.vectors * kernels::kLanes + 1;
    const int rows = shape_.side + 1;
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
  alignas(32) std::array<float, kMaxSide * 3 * kernels::kLanes + kernels::kLanes> patch_;
  std::array<std::uint8_t, kMaxRows * kMaxColumns> border_;
};

}  // namespace tet_line_tracker
