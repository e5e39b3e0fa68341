#pragma once

#include <cstdint>
#include <vector>

namespace tet_line_tracker {

/// Irregularity of plaster, wood and stone: noise of all sizes from 8 mm to 2 m, mean 0, deviation 1,
/// repeated every 4 m, with coarser copies so that it fades with distance instead of flickering.
class Grain {
 public:
  explicit Grain(std::uint64_t seed);

  /// Mean over about a square of side `footprint` [m].
  float at(float u, float v, float footprint) const;

 private:
  struct Level {
    int size;
    std::vector<float> values;
  };
  static float sample(const Level& level, float x, float y);

  std::vector<Level> levels_;
};

}  // namespace tet_line_tracker
