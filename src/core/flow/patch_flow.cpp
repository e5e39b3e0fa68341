#include "flow/patch_flow.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {
namespace {

/// Mean squared gray difference that any picture has [gray^2].
constexpr float kGrayNoise = 4.0F;

/// Scale of the weights: at this multiple of the median squared difference the weight is a quarter.
constexpr float kMedianScale = 2.25F;

}  // namespace

void computeGemanMcClureWeights(PatchMatch* matches, std::size_t count) {
  // Sorted by insertion: there are few.
  std::array<float, kMaxPatches> squares;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t k = i;
    for (; k > 0 && squares[k - 1] > matches[i].square; --k) squares[k] = squares[k - 1];
    squares[k] = matches[i].square;
  }
  const float per_scale = 1.0F / (kMedianScale * std::max(squares[count / 2], kGrayNoise));
  for (std::size_t i = 0; i < count; ++i) {
    const float root = 1.0F + matches[i].square * per_scale;
    matches[i].weight = 1.0F / (root * root);
  }
}

void JointEquations::add(const PatchMatch& match) {
  const kernels::PatchTemplate& reference = match.patch->reference;
  const float end = match.weight * match.patch->fraction;
  const float start = match.weight - end;
  const auto grow = [&reference](SymmetricMatrix& block, float share) {
    block.xx += share * reference.xx;
    block.xy += share * reference.xy;
    block.yy += share * reference.yy;
  };
  grow(start_, start * (1.0F - match.patch->fraction));
  grow(coupling_, start * match.patch->fraction);
  grow(end_, end * match.patch->fraction);
  start_slope_ += start * match.slope;
  end_slope_ += end * match.slope;
}

void JointEquations::addPrior(const LineSegment& segment, const LineSegment& expected, float weight) {
  start_.xx += weight;
  start_.yy += weight;
  end_.xx += weight;
  end_.yy += weight;
  start_slope_ += weight * (segment.start - expected.start);
  end_slope_ += weight * (segment.end - expected.end);
}

std::pair<Eigen::Vector2f, Eigen::Vector2f> JointEquations::solve() const {
  // By blocks: start eliminated first (Schur complement). All blocks are symmetric, but a product of two is
  // not; that of three, coupling inverse(start) coupling, is again.
  const SymmetricMatrix inverse = start_.inverse();
  const Eigen::Vector2f first = inverse * Eigen::Vector2f(coupling_.xx, coupling_.xy);
  const Eigen::Vector2f second = inverse * Eigen::Vector2f(coupling_.xy, coupling_.yy);
  const SymmetricMatrix rest = {end_.xx - coupling_.xx * first.x() - coupling_.xy * first.y(),
                                end_.xy - coupling_.xx * second.x() - coupling_.xy * second.y(),
                                end_.yy - coupling_.xy * second.x() - coupling_.yy * second.y()};
  const Eigen::Vector2f alone = inverse * start_slope_;
  const Eigen::Vector2f end = rest.inverse() * (coupling_ * alone - end_slope_);
  return {-alone - inverse * (coupling_ * end), end};
}

}  // namespace tet_line_tracker
