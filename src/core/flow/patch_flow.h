#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "kernels/kernels.h"
#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

constexpr std::size_t kMaxPatches = 16;

constexpr float kGrayRange = 255.0F;  // gray thresholds are on [0, 1]

/// Largest movement on one pyramid level, in windows: beyond it the gradients say nothing of the place.
constexpr float kMaxMovement = 1.0F;

/// A patch whose gain leaves this range shows something else.
constexpr float kMinGain = 0.2F;
constexpr float kMaxGain = 5.0F;

/// A patch at `fraction` of the way from start to end: it moves by (1 - fraction) m1 + fraction m2.
struct Patch {
  float fraction{0.0F};
  kernels::PatchTemplate reference{};
};

/// The patches of a segment on one pyramid level, from start to end.
struct PatchRow {
  std::vector<Patch> patches;  ///< as many as there may be
  std::size_t count{0};        ///< in use
};

/// A patch against the second image at some place.
struct PatchMatch {
  const Patch* patch{nullptr};
  Eigen::Vector2f slope{Eigen::Vector2f::Zero()};  ///< gradient of half the squared difference [gray^2 / px]
  float gain{1.0F}, offset{0.0F};  ///< of the second image over the template, which has no mean
  float square{0.0F};              ///< mean squared difference [gray^2]
  float absolute{0.0F};            ///< mean absolute difference, when gain and offset are not matched [gray]
  float weight{1.0F};
};

/// Match with gain and offset, within the limits of what light does. The template is projected: its gradients
/// do not see them.
inline PatchMatch matchOf(const Patch& patch, const kernels::AlignmentSums& sums, float pixels) {
  const kernels::PatchTemplate& reference = patch.reference;
  PatchMatch match;
  match.patch = &patch;
  // A template without contrast fits any gain.
  if (reference.gray_gray > 0.0F) {
    match.gain = std::clamp(sums.i_gray / reference.gray_gray, kMinGain, kMaxGain);
  }
  match.offset = sums.i / pixels;
  const float shrink = 1.0F / match.gain;
  match.slope = Eigen::Vector2f(sums.i_x, sums.i_y) * shrink;
  const float squares =
      ((sums.i_i - sums.i * match.offset) * shrink - 2.0F * sums.i_gray) * shrink + reference.gray_gray;
  match.square = std::max(0.0F, squares) / pixels;
  return match;
}

/// Match of the gray values as they are.
inline PatchMatch matchOf(const Patch& patch, const kernels::DifferenceSums& sums, float pixels) {
  PatchMatch match;
  match.patch = &patch;
  match.slope = Eigen::Vector2f(sums.x, sums.y);
  match.square = sums.square / pixels;
  match.absolute = sums.absolute / pixels;
  return match;
}

/// Sets the Geman-McClure weights of at most kMaxPatches matches: less for those that are worse than the
/// others, as covered patches or another background.
void computeGemanMcClureWeights(PatchMatch* matches, std::size_t count);

/// A symmetric 2x2 matrix.
struct SymmetricMatrix {
  float xx{0.0F}, xy{0.0F}, yy{0.0F};

  float determinant() const { return xx * yy - xy * xy; }
  SymmetricMatrix inverse() const {
    const float scale = 1.0F / determinant();
    return {yy * scale, -xy * scale, xx * scale};
  }
  Eigen::Vector2f operator*(const Eigen::Vector2f& v) const {
    return {xx * v.x() + xy * v.y(), xy * v.x() + yy * v.y()};
  }
};

/// The 4x4 system of both movement vectors.
class JointEquations {
 public:
  void add(const PatchMatch& match);
  /// A prior on both endpoints: where they are expected, with the weight of a gradient of `weight` [gray^2 /
  /// px^2].
  void addPrior(const LineSegment& segment, const LineSegment& expected, float weight);
  /// Steps of start and end [px]; not finite when the system is singular.
  std::pair<Eigen::Vector2f, Eigen::Vector2f> solve() const;

 private:
  SymmetricMatrix start_, coupling_, end_;  ///< blocks of the matrix
  Eigen::Vector2f start_slope_{Eigen::Vector2f::Zero()};
  Eigen::Vector2f end_slope_{Eigen::Vector2f::Zero()};
};

}  // namespace tet_line_tracker
