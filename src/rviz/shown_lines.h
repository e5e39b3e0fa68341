#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "colour_scale.h"

namespace tet_line_tracker {

/// A line as it is drawn [m].
struct ShownLine {
  Eigen::Vector3f start;
  Eigen::Vector3f end;
  Colour colour;
  std::string label;                       ///< beside its middle; empty: none
  std::vector<Eigen::Vector3f> between{};  ///< points between the ends, in their order; none: straight
};

/// What is drawn of a message, and what is not.
struct ShownLines {
  std::vector<ShownLine> lines;
  std::size_t shown{0};          ///< lines of the message that are drawn
  std::size_t hidden{0};         ///< left out by the settings of the display
  std::size_t without_place{0};  ///< no finite endpoints
};

}  // namespace tet_line_tracker
