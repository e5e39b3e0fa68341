#include "geometry/coverage_grid.h"

#include <algorithm>

#include "geometry/clamp.h"

namespace tet_line_tracker {

void CoverageGrid::add(const LineCurve& line) {
  // Steps of a quarter of the smaller cell side miss only corners that a line barely touches.
  const float cell = std::min(width_ / kColumns, height_ / kRows);
  const int steps = 1 + static_cast<int>(clampOrLow(4.0F * line.chord.length() / cell, 0.0F, 1e4F));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2f p = line.at(static_cast<float>(i) / static_cast<float>(steps));
    const int column = static_cast<int>(clampOrLow(p.x() * kColumns / width_, 0.0F, kColumns - 1));
    const int row = static_cast<int>(clampOrLow(p.y() * kRows / height_, 0.0F, kRows - 1));
    crossed_.set(static_cast<std::size_t>(row * kColumns + column));
  }
}

float CoverageGrid::coverage() const {
  return static_cast<float>(crossed_.count()) / static_cast<float>(crossed_.size());
}

}  // namespace tet_line_tracker
