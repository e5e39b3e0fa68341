#include "colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {

Colour colourOnScale(double place) {
  // The colours of the ages of tracks, from the oldest to the youngest.
  static constexpr std::array<std::array<float, 3>, 4> kColours{
      {{0.25F, 0.6F, 1.0F}, {0.25F, 0.9F, 0.35F}, {1.0F, 0.82F, 0.1F}, {1.0F, 0.25F, 0.2F}}};
  if (std::isnan(place)) return kUnknownColour;
  const double step = std::clamp(place, 0.0, 1.0) * static_cast<double>(kColours.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(step), kColours.size() - 2);
  const auto share = static_cast<float>(step - static_cast<double>(lower));
  const auto channel = [&](std::size_t i) {
    return (1.0F - share) * kColours[lower][i] + share * kColours[lower + 1][i];
  };
  return {channel(0), channel(1), channel(2), 1.0F};
}

double placeBetween(double low, double high, double value) {
  if (std::isnan(value)) return value;
  return high > low ? (value - low) / (high - low) : 0.5;
}

Colour colourOfTrackAge(std::uint32_t age) {
  const std::array<float, 3> rgb = colourOfAge(age);
  return {rgb[0], rgb[1], rgb[2], 1.0F};
}

Colour colourOfId(std::uint64_t id) {
  // Steps of the golden ratio around the circle of hues never come close to those before.
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  // of 2^64
  const double hue = std::ldexp(static_cast<double>((id * kGoldenRatio) >> 11U), -53);
  const auto channel = [hue](double peak) {
    double distance = std::abs(hue - peak);
    distance = std::min(distance, 1.0 - distance);
    return static_cast<float>(std::clamp(2.0 - 6.0 * distance, 0.15, 1.0));
  };
  return {channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0), 1.0F};
}

}  // namespace tet_line_tracker
