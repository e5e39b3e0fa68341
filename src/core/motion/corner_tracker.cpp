#include "motion/corner_tracker.h"

#include <algorithm>
#include <cmath>

#include "image/patch_reader.h"
#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {
namespace {

constexpr int kMaxIterations = 8;
constexpr float kCoarseStep = 0.2F;  ///< iterations end below it [px of the level]
constexpr float kFineStep = 0.05F;
constexpr float kMaxMismatch = 0.2F;  ///< share of the contrast of a patch that may not match
constexpr float kGrayNoise = 9.0F;    ///< variance of the gray values that any picture has [gray^2]
constexpr int kSureLevel = 2;         ///< where the flow begins for corners whose place is nearly known

constexpr int kSelectionLevel = 2;
constexpr int kHalfWindow = 2;            ///< of the sums of gradient products [px of the level]
constexpr float kMinEigenvalue = 400.0F;  ///< of the sums that noise does not reach [(gray / 2 px)^2]
constexpr int kBorder = 3;                ///< of the selection level [px]

}  // namespace

CornerTracker::CornerTracker() : corners_(static_cast<std::size_t>(kColumns * kRows)) {
  for (Corner& corner : corners_) {
    float* next = corner.values.data();
    for (Patch& patch : corner.patches) {
      for (float** part : {&patch.reference.gray, &patch.reference.gradient_x, &patch.reference.gradient_y}) {
        *part = next;
        next += Corner::kShape.floats();
      }
    }
  }
}

void CornerTracker::clear() {
  for (Corner& corner : corners_) corner.used = false;
}

void CornerTracker::follow(const ImagePyramid& pyramid) {
  for (Corner& corner : corners_) {
    corner.fresh = false;
    if (corner.used) corner.used = followCorner(pyramid, corner);
  }
}

bool CornerTracker::followCorner(const ImagePyramid& pyramid, Corner& corner) const {
  constexpr kernels::PatchShape shape = Corner::kShape;
  constexpr auto pixels = static_cast<float>(shape.side * shape.side);
  alignas(32) std::array<float, static_cast<std::size_t>(shape.floats())> gray;
  PatchReader reader(shape);
  Eigen::Vector2f pixel = corner.expected;
  const int top = std::min(pyramid.levels(), kPyramidLevels) - 1;
  for (int j = corner.sure ? std::min(top, kSureLevel) : top; j >= Corner::kFinest; --j) {
    const Patch& patch = corner.patches[static_cast<std::size_t>(j - Corner::kFinest)];
    const kernels::PatchTemplate& reference = patch.reference;
    const SymmetricMatrix hessian{reference.xx, reference.xy, reference.yy};
    // A level that shows no corner leaves its place to the next.
    if (!(hessian.determinant() > 1e-3F * (hessian.xx + hessian.yy) * (hessian.xx + hessian.yy))) {
      if (j == Corner::kFinest) return false;
      continue;
    }
    const SymmetricMatrix inverse = hessian.inverse();
    const float scale = ImagePyramid::scale(j);
    const Eigen::Vector2f start = scale * pixel;
    Eigen::Vector2f centre = start;
    const ImageBounds bounds = ImageBounds::ofImage(pyramid.level(j).cols, pyramid.level(j).rows);
    const float last_step = j == Corner::kFinest ? kFineStep : kCoarseStep;
    float square = 0.0F;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      if (!bounds.contains(centre)) return false;
      kernels::AlignmentSums sums;
      kernels::active().align(reader.patch(pyramid.level(j), centre), shape, reference, gray.data(), &sums);
      const PatchMatch match = matchOf(patch, sums, pixels);
      square = match.square;
      const Eigen::Vector2f step = -(inverse * match.slope);
      centre += step;
      // Written so that NaN fails.
      if (!((centre - start).norm() <= kMaxMovement * static_cast<float>(shape.side))) return false;
      if (step.norm() < last_step) break;
    }
    pixel = centre / scale;
    if (j == Corner::kFinest && square > kMaxMismatch * reference.gray_gray / pixels + kGrayNoise)
      return false;
  }
  corner.pixel = pixel;
  return true;
}

void CornerTracker::extractTemplates(const ImagePyramid& pyramid) {
  addCorners(pyramid);
  constexpr kernels::PatchShape shape = Corner::kShape;
  PatchReader reader(shape);
  const int levels = std::min(pyramid.levels(), kPyramidLevels);
  for (Corner& corner : corners_) {
    if (!corner.used) continue;
    for (int j = Corner::kFinest; j < levels; ++j) {
      Patch& patch = corner.patches[static_cast<std::size_t>(j - Corner::kFinest)];
      const Eigen::Vector2f centre = ImagePyramid::scale(j) * corner.pixel;
      kernels::active().makeTemplate(reader.patchWithRim(pyramid.level(j), centre), shape, true,
                                     &patch.reference);
    }
  }
}

void CornerTracker::addCorners(const ImagePyramid& pyramid) {
  if (pyramid.levels() <= kSelectionLevel) return;
  const cv::Mat& level = pyramid.level(kSelectionLevel);
  const float scale = ImagePyramid::scale(kSelectionLevel);
  std::array<bool, static_cast<std::size_t>(kColumns * kRows)> taken{};
  const auto cellOf = [&](const Eigen::Vector2f& pixel) {
    const int column = static_cast<int>(scale * pixel.x()) * kColumns / level.cols;
    const int row = static_cast<int>(scale * pixel.y()) * kRows / level.rows;
    return static_cast<std::size_t>(std::clamp(row, 0, kRows - 1) * kColumns +
                                    std::clamp(column, 0, kColumns - 1));
  };
  for (Corner& corner : corners_) {
    // Two in a cell tell hardly more than one.
    if (!corner.used) continue;
    bool& cell = taken[cellOf(corner.pixel)];
    if (cell) corner.used = false;
    cell = true;
  }
  std::size_t slot = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      if (taken[static_cast<std::size_t>(row * kColumns + column)]) continue;
      const int left = std::max(kBorder, level.cols * column / kColumns);
      const int top = std::max(kBorder, level.rows * row / kRows);
      const int right = std::min(level.cols - kBorder, level.cols * (column + 1) / kColumns);
      const int bottom = std::min(level.rows - kBorder, level.rows * (row + 1) / kRows);
      Eigen::Vector2f pixel;
      if (right <= left || bottom <= top ||
          !bestCorner(level, cv::Rect(left, top, right - left, bottom - top), pixel)) {
        continue;
      }
      while (corners_[slot].used) ++slot;
      Corner& corner = corners_[slot];
      corner.used = true;
      corner.fresh = true;
      corner.pixel = pixel / scale;
    }
  }
}

bool CornerTracker::bestCorner(const cv::Mat& level, const cv::Rect& cell, Eigen::Vector2f& pixel) {
  constexpr int kWindow = 2 * kHalfWindow + 1;
  const int columns = cell.width;
  const int rows = cell.height + 2 * kHalfWindow;
  products_.assign(static_cast<std::size_t>(columns * rows), {0.0F, 0.0F, 0.0F});
  for (int r = 0; r < rows; ++r) {
    // Gradients exist from the second row and column to the last but one.
    const int y = std::clamp(cell.y + r - kHalfWindow, 1, level.rows - 2);
    const std::uint8_t* above = level.ptr<std::uint8_t>(y - 1);
    const std::uint8_t* middle = level.ptr<std::uint8_t>(y);
    const std::uint8_t* below = level.ptr<std::uint8_t>(y + 1);
    for (int c = 0; c < columns; ++c) {
      std::array<float, 3>& sums = products_[static_cast<std::size_t>(r * columns + c)];
      for (int k = -kHalfWindow; k <= kHalfWindow; ++k) {
        const int x = std::clamp(cell.x + c + k, 1, level.cols - 2);
        const auto dx = static_cast<float>(middle[x + 1] - middle[x - 1]);
        const auto dy = static_cast<float>(below[x] - above[x]);
        sums[0] += dx * dx;
        sums[1] += dx * dy;
        sums[2] += dy * dy;
      }
    }
  }
  float best = kMinEigenvalue;
  bool found = false;
  for (int r = 0; r < cell.height; ++r) {
    for (int c = 0; c < columns; ++c) {
      float xx = 0.0F;
      float xy = 0.0F;
      float yy = 0.0F;
      for (int k = 0; k < kWindow; ++k) {
        const std::array<float, 3>& sums = products_[static_cast<std::size_t>((r + k) * columns + c)];
        xx += sums[0];
        xy += sums[1];
        yy += sums[2];
      }
      const float smaller = 0.5F * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4.0F * xy * xy));
      if (smaller <= best) continue;
      best = smaller;
      found = true;
      pixel = {static_cast<float>(cell.x + c), static_cast<float>(cell.y + r)};
    }
  }
  return found;
}

}  // namespace tet_line_tracker
