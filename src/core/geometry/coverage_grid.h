#pragma once

#include <bitset>

#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// Counts the cells of an 8x6 grid over an image that lines cross.
class CoverageGrid {
 public:
  /// Size of the image [px].
  CoverageGrid(int width, int height)
      : width_(static_cast<float>(width)), height_(static_cast<float>(height)) {}

  /// Along the curve, where the lens bends the line.
  void add(const LineCurve& line);
  /// Share of the cells that are crossed, 0..1.
  float coverage() const;

 private:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  float width_, height_;
  std::bitset<static_cast<std::size_t>(kColumns* kRows)> crossed_;
};

}  // namespace tet_line_tracker
