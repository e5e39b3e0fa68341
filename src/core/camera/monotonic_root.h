#pragma once

#include <cmath>

namespace tet_line_tracker {

/// A value of a function and its derivative there.
struct ValueAndSlope {
  double value;
  double slope;
};

/// The x in [low, high] at which `function(x).value` is `target`, for a function that increases there; the
/// nearer end when the target lies outside. Newton, held inside a bracket that bisection shrinks: it always
/// arrives.
template <class Function>
double solveMonotonic(const Function& function, double target, double low, double high) {
  double x = std::fmin(std::fmax(target, low), high);
  for (int i = 0; i < 100; ++i) {
    const ValueAndSlope f = function(x);
    const double error = f.value - target;
    (error > 0.0 ? high : low) = x;
    double next = x - error / f.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15 * (1.0 + std::abs(x))) return next;
    x = next;
  }
  return x;
}

/// Largest x up to `limit` before which `slope` stays positive, found in steps and then by bisection.
template <class Slope>
double endOfMonotonicRange(const Slope& slope, double step, double limit) {
  const int steps = static_cast<int>(limit / step);
  for (int i = 1; i <= steps; ++i) {
    if (slope(i * step) > 0.0) continue;
    double low = (i - 1) * step;
    double high = i * step;
    while (high - low > 1e-9) {
      const double middle = 0.5 * (low + high);
      (slope(middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return limit;
}

}  // namespace tet_line_tracker
