#include "patch_flow.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tet_line_tracker {
namespace {

/// A patch whose gain leaves this range shows something else.
constexpr float kMinGain = 0.2F;
constexpr float kMaxGain = 5.0F;

/// Spread of gray differences that any picture has [gray].
constexpr float kGrayNoise = 2.0F;

}  // namespace

float gainOf(const kernels::PatchTemplate& reference, const kernels::AlignmentSums& sums) {
  // A template without contrast fits any gain.
  if (reference.gray_gray <= 0.0F) return 1.0F;
  return std::clamp(sums.i_gray / reference.gray_gray, kMinGain, kMaxGain);
}

PatchMatch matchOf(const Patch& patch, const kernels::AlignmentSums& sums, float pixels,
                   bool gain_and_offset) {
  const kernels::PatchTemplate& reference = patch.reference;
  PatchMatch match;
  match.patch = &patch;
  float squares = 0.0F;
  if (gain_and_offset) {
    // The projected gradients do not see gain and offset: the gray value itself serves as the difference.
    const float gain = gainOf(reference, sums);
    match.slope = Eigen::Vector2f(sums.i_x, sums.i_y) / gain;
    squares =
        sums.i_i - sums.i * sums.i / pixels - 2.0F * gain * sums.i_gray + gain * gain * reference.gray_gray;
    squares /= gain * gain;
  } else {
    match.slope = Eigen::Vector2f(sums.i_x - reference.gray_x, sums.i_y - reference.gray_y);
    squares = sums.i_i - 2.0F * sums.i_gray + reference.gray_gray;
  }
  match.spread = std::sqrt(std::max(0.0F, squares) / pixels);
  return match;
}

void weigh(PatchMatch* matches, std::size_t count) {
  std::array<float, kMaxPatches> spreads;
  for (std::size_t i = 0; i < count; ++i) spreads[i] = matches[i].spread;
  const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(spreads.begin(), middle, spreads.begin() + static_cast<std::ptrdiff_t>(count));
  const float scale = 1.5F * std::max(*middle, kGrayNoise);
  for (std::size_t i = 0; i < count; ++i) {
    const float ratio = matches[i].spread / scale;
    const float weight = 1.0F / (1.0F + ratio * ratio);
    matches[i].weight = weight * weight;
  }
}

void NormalEquations::add(const PatchMatch& match) {
  const kernels::PatchTemplate& reference = match.patch->reference;
  Eigen::Matrix2f gradients;
  gradients << reference.xx, reference.xy, reference.xy, reference.yy;
  const float f1 = match.patch->fraction;
  const float f0 = 1.0F - f1;
  matrix_.topLeftCorner<2, 2>() += match.weight * f0 * f0 * gradients;
  matrix_.topRightCorner<2, 2>() += match.weight * f0 * f1 * gradients;
  matrix_.bottomLeftCorner<2, 2>() += match.weight * f0 * f1 * gradients;
  matrix_.bottomRightCorner<2, 2>() += match.weight * f1 * f1 * gradients;
  slope_.head<2>() += match.weight * f0 * match.slope;
  slope_.tail<2>() += match.weight * f1 * match.slope;
}

void NormalEquations::hold(const LineSegment& segment, const LineSegment& expected, float weight) {
  matrix_.diagonal().array() += weight;
  slope_.head<2>() += weight * (segment.start - expected.start);
  slope_.tail<2>() += weight * (segment.end - expected.end);
}

float NormalEquations::determinantOfEndpoint(int endpoint) const {
  return matrix_.block<2, 2>(2 * endpoint, 2 * endpoint).determinant();
}

std::pair<Eigen::Vector2f, Eigen::Vector2f> NormalEquations::solve() const {
  // By blocks: start eliminated first (Schur complement), in closed form.
  const Eigen::Matrix2f a_inverse = matrix_.topLeftCorner<2, 2>().inverse();
  const Eigen::Matrix2f coupling = matrix_.bottomLeftCorner<2, 2>() * a_inverse;
  const Eigen::Matrix2f rest = matrix_.bottomRightCorner<2, 2>() - coupling * matrix_.topRightCorner<2, 2>();
  const Eigen::Vector2f end = -(rest.inverse() * (slope_.tail<2>() - coupling * slope_.head<2>()));
  const Eigen::Vector2f start = -(a_inverse * (slope_.head<2>() + matrix_.topRightCorner<2, 2>() * end));
  return {start, end};
}

}  // namespace tet_line_tracker
