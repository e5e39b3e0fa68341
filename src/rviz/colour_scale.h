#pragma once

#include <cstdint>

namespace tet_line_tracker {

/// Red, green, blue and opacity, each 0..1.
struct Colour {
  float red{1.0F};
  float green{1.0F};
  float blue{1.0F};
  float alpha{1.0F};
};

/// What is not known, as a sigma that was not estimated: gray.
constexpr Colour kUnknownColour{0.6F, 0.6F, 0.6F, 1.0F};

/// From blue (0) over green and yellow to red (1); values outside count as the nearer end, NaN is
/// kUnknownColour.
Colour colourOnScale(double place);

/// Place of `value` between `low` (0) and `high` (1); 0.5 where they are equal, NaN where a number is.
double placeBetween(double low, double high, double value);

/// Colour of a track by its age in images, as in the debug image.
Colour colourOfTrackAge(std::uint32_t age);

/// A colour of its own for each id: the same at all times, and far apart for ids that follow each other.
Colour colourOfId(std::uint64_t id);

}  // namespace tet_line_tracker
