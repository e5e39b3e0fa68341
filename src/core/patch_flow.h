#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "kernels/kernels.h"
#include "tet_line_tracker/line_segment.h"

namespace tet_line_tracker {

constexpr std::size_t kMaxPatches = 16;

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
  float spread{0.0F};      ///< root mean square difference, gain and offset matched if so asked
  float difference{0.0F};  ///< mean absolute difference [gray]; 0 when not asked for
  float weight{1.0F};
};

/// Match of a patch whose sums are known. `gain_and_offset`: the template was projected.
PatchMatch matchOf(const Patch& patch, const kernels::AlignmentSums& sums, float pixels,
                   bool gain_and_offset);

/// Gain of the second image over the template, limited to what light does.
float gainOf(const kernels::PatchTemplate& reference, const kernels::AlignmentSums& sums);

/// Less weight for matches that are worse than the others: covered patches, moved background.
void weigh(PatchMatch* matches, std::size_t count);

/// The 4x4 system of both movement vectors.
class NormalEquations {
 public:
  void add(const PatchMatch& match);
  /// Ties both endpoints to where they are expected, with the weight of a gradient of `weight` [gray^2 /
  /// px^2].
  void hold(const LineSegment& segment, const LineSegment& expected, float weight);
  /// Determinant of the gradient matrix of endpoint 0 or 1 alone.
  float determinantOfEndpoint(int endpoint) const;
  /// Steps of start and end [px]; not finite when the system is singular.
  std::pair<Eigen::Vector2f, Eigen::Vector2f> solve() const;

 private:
  Eigen::Matrix4f matrix_{Eigen::Matrix4f::Zero()};
  Eigen::Vector4f slope_{Eigen::Vector4f::Zero()};
};

}  // namespace tet_line_tracker
