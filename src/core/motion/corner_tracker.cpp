#include "motion/corner_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "image/patch_reader.h"
#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {
namespace {

constexpr int kMaxIterations = 8;
constexpr float kCoarseStep = 0.2F;  ///< iterations end below it [px of the level]
constexpr float kFineStep = 0.05F;
constexpr float kMaxMismatch = 0.2F;  ///< share of the contrast of a patch that may not match
constexpr float kGrayNoise = 9.0F;    ///< variance of the gray values that any picture has [gray^2]
constexpr int kCoarsestEnd = 1;  ///< a place is exact enough that the flow has on this level or a finer one
constexpr int kSureLevel = 2;    ///< where the flow begins for corners whose place is nearly known

constexpr int kSelectionLevel = 2;
constexpr int kHalfWindow = 2;            ///< of the sums of gradient products [px of the level]
constexpr float kMinEigenvalue = 400.0F;  ///< of the sums that noise does not reach [(gray / 2 px)^2]
constexpr int kManyCorners = 40;
constexpr int kBorder = 3;       ///< of the selection level [px]
constexpr int kExactReach = 10;  ///< of a corner's exact place round that of the selection level [px]

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
  odd_turn_ = false;
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
  int finest = kPyramidLevels;  // level that showed a corner
  float mismatch = 0.0F;        // there, beyond what may be
  for (int j = corner.sure ? std::min(top, kSureLevel) : top; j >= 0; --j) {
    const Patch& patch = corner.patches[static_cast<std::size_t>(j)];
    const kernels::PatchTemplate& reference = patch.reference;
    const SymmetricMatrix hessian{reference.xx, reference.xy, reference.yy};
    // A level that shows no corner leaves its place to the next.
    if (!(hessian.determinant() > 1e-3F * (hessian.xx + hessian.yy) * (hessian.xx + hessian.yy))) continue;
    const SymmetricMatrix inverse = hessian.inverse();
    const float scale = ImagePyramid::scale(j);
    const Eigen::Vector2f start = scale * pixel;
    Eigen::Vector2f centre = start;
    const ImageBounds bounds = ImageBounds::ofImage(pyramid.level(j).cols, pyramid.level(j).rows);
    const float last_step = j == 0 ? kFineStep : kCoarseStep;
    finest = j;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      if (!bounds.contains(centre)) return false;
      kernels::AlignmentSums sums;
      kernels::active().align(reader.patch(pyramid.level(j), centre), shape, reference, gray.data(), &sums);
      const PatchMatch match = matchOf(patch, sums, pixels);
      mismatch = match.square - kMaxMismatch * reference.gray_gray / pixels;
      const Eigen::Vector2f step = -(inverse * match.slope);
      centre += step;
      // Written so that NaN fails.
      if (!((centre - start).norm() <= kMaxMovement * static_cast<float>(shape.side))) return false;
      if (step.norm() < last_step) break;
    }
    pixel = centre / scale;
  }
  corner.pixel = pixel;
  return finest <= kCoarsestEnd && mismatch <= kGrayNoise;
}

void CornerTracker::extractTemplates(const ImagePyramid& pyramid) {
  addCorners(pyramid);
  constexpr kernels::PatchShape shape = Corner::kShape;
  PatchReader reader(shape);
  const int levels = std::min(pyramid.levels(), kPyramidLevels);
  for (Corner& corner : corners_) {
    if (!corner.used) continue;
    for (int j = 0; j < levels; ++j) {
      Patch& patch = corner.patches[static_cast<std::size_t>(j)];
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
  int used = 0;
  for (Corner& corner : corners_) {
    // Two in a cell tell hardly more than one.
    if (!corner.used) continue;
    bool& cell = taken[cellOf(corner.pixel)];
    if (cell) {
      corner.used = false;
    } else {
      ++used;
    }
    cell = true;
  }
  // Where there are many, every second empty cell waits for the next image.
  odd_turn_ = !odd_turn_;
  const bool all = used < kManyCorners;
  std::size_t slot = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      if (taken[static_cast<std::size_t>(row * kColumns + column)]) continue;
      if (!all && ((row + column) % 2 == 1) != odd_turn_) continue;
      const int left = std::max(kBorder, level.cols * column / kColumns);
      const int top = std::max(kBorder, level.rows * row / kRows);
      const int right = std::min(level.cols - kBorder, level.cols * (column + 1) / kColumns);
      const int bottom = std::min(level.rows - kBorder, level.rows * (row + 1) / kRows);
      Eigen::Vector2f pixel;
      const cv::Rect cell(left, top, right - left, bottom - top);
      if (right <= left || bottom <= top || !bestCorner(level, cell, pixel)) continue;
      while (corners_[slot].used) ++slot;
      Corner& corner = corners_[slot];
      corner.used = true;
      corner.fresh = true;
      corner.pixel = exactPlace(pyramid.level(0), cell, pixel / scale);
    }
  }
}

Eigen::Vector2f CornerTracker::exactPlace(const cv::Mat& image, const cv::Rect& cell,
                                          const Eigen::Vector2f& pixel) {
  constexpr int kScale = 1 << kSelectionLevel;
  const cv::Rect inside = cv::Rect(kBorder, kBorder, image.cols - 2 * kBorder, image.rows - 2 * kBorder) &
                          cv::Rect(cell.tl() * kScale, cell.br() * kScale);
  const cv::Rect around(static_cast<int>(pixel.x()) - kExactReach, static_cast<int>(pixel.y()) - kExactReach,
                        2 * kExactReach + 1, 2 * kExactReach + 1);
  Eigen::Vector2f exact;
  return bestCorner(image, around & inside, exact) ? exact : pixel;
}

bool CornerTracker::bestCorner(const cv::Mat& level, const cv::Rect& cell, Eigen::Vector2f& pixel) {
  // Sums of products over the window: first along rows, then along columns. They are whole numbers.
  static_assert(kBorder > kHalfWindow, "gradients exist from the second row and column to the last but one");
  constexpr int kWindow = 2 * kHalfWindow + 1;
  const auto columns = static_cast<std::size_t>(cell.width);
  const std::size_t wide = columns + kWindow - 1;
  const auto rows = static_cast<std::size_t>(cell.height + kWindow - 1);
  sums_.resize(3 * (rows * columns + wide));
  std::array<std::int32_t*, 3> products;
  std::array<std::int32_t*, 3> sums;
  for (std::size_t k = 0; k < 3; ++k) {
    products[k] = sums_.data() + k * wide;
    sums[k] = sums_.data() + 3 * wide + k * rows * columns;
  }
  for (std::size_t r = 0; r < rows; ++r) {
    const int y = cell.y - kHalfWindow + static_cast<int>(r);
    const int left = cell.x - kHalfWindow;
    const std::uint8_t* above = level.ptr<std::uint8_t>(y - 1) + left;
    const std::uint8_t* middle = level.ptr<std::uint8_t>(y) + left - 1;
    const std::uint8_t* below = level.ptr<std::uint8_t>(y + 1) + left;
    for (std::size_t c = 0; c < wide; ++c) {
      const std::int32_t dx = middle[c + 2] - middle[c];
      const std::int32_t dy = below[c] - above[c];
      products[0][c] = dx * dx;
      products[1][c] = dx * dy;
      products[2][c] = dy * dy;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t* product = products[k];
      std::int32_t* sum = sums[k] + r * columns;
      for (std::size_t c = 0; c < columns; ++c) {
        sum[c] = product[c] + product[c + 1] + product[c + 2] + product[c + 3] + product[c + 4];
      }
    }
  }
  static_assert(kWindow == 5, "sums of five");
  float best = kMinEigenvalue;
  bool found = false;
  for (int r = 0; r < cell.height; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t* sum = sums[k] + static_cast<std::size_t>(r) * columns;
      for (std::size_t c = 0; c < columns; ++c) {
        products[k][c] =
            sum[c] + sum[c + columns] + sum[c + 2 * columns] + sum[c + 3 * columns] + sum[c + 4 * columns];
      }
    }
    for (std::size_t c = 0; c < columns; ++c) {
      const auto xx = static_cast<float>(products[0][c]);
      const auto xy = static_cast<float>(products[1][c]);
      const auto yy = static_cast<float>(products[2][c]);
      // Both eigenvalues are larger than `best`, told without a root.
      if (!(xx > best && (xx - best) * (yy - best) > xy * xy)) continue;
      best = 0.5F * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4.0F * xy * xy));
      found = true;
      pixel = {static_cast<float>(cell.x + static_cast<int>(c)), static_cast<float>(cell.y + r)};
    }
  }
  return found;
}

}  // namespace tet_line_tracker
