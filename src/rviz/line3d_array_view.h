#pragma once

#include <cstdint>
#include <limits>

#include "shown_lines.h"
#include "tet_line_tracker/Line3DArray.h"

namespace tet_line_tracker {

/// How a map of lines is shown.
struct Line3DArrayStyle {
  enum class Colouring { kSigma, kHeight, kState };

  Colouring colouring{Colouring::kSigma};
  double largest_sigma{0.1};        ///< sigma from which on a line has the last colour [m]
  bool height_bounds_of_map{true};  ///< the colours of heights go from the lowest to the highest line shown
  double lowest{0.0};               ///< height with the first colour, else [m]
  double highest{3.0};              ///< height with the last colour, else [m]
  bool live{true};                  ///< show lines that are still tracked
  bool finished{true};              ///< show lines that will not change any more
  double max_sigma{std::numeric_limits<double>::infinity()};  ///< less certain lines are not shown [m]
  std::uint32_t min_views{0};                                 ///< lines that fewer images saw are not shown
  float alpha{1.0F};
  bool ids{false};
};

/// The lines of a map, in its frame. Heights are those of the middles of lines, along z; the sigma of a line
/// is the larger one of its ends.
ShownLines showMap(const Line3DArray& map, const Line3DArrayStyle& style);

}  // namespace tet_line_tracker
