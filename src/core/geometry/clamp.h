#pragma once

namespace tet_line_tracker {

/// `value` held in [low, high], NaN held at `low`: what comes out can be cast to an integer. std::clamp lets
/// NaN through, and casting NaN is undefined.
inline float clampOrLow(float value, float low, float high) {
  return value > low ? (value < high ? value : high) : low;
}

}  // namespace tet_line_tracker
