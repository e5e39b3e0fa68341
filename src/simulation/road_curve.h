#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "counter_random.h"

namespace tet_line_tracker {

/// Centre line of a winding street along x: two sines, bends of 35 m radius and more.
class RoadCurve {
 public:
  explicit RoadCurve(std::uint64_t seed) {
    RandomSequence random(seed, 7);
    phase_ = random.uniform(0.0, 2.0 * M_PI);
    second_phase_ = random.uniform(0.0, 2.0 * M_PI);
  }

  double y(double x) const {
    return kAmplitude * std::sin(kWave * x + phase_) +
           kSecondAmplitude * std::sin(kSecondWave * x + second_phase_);
  }
  /// Angle of the street about z [rad].
  double heading(double x) const {
    return std::atan(kAmplitude * kWave * std::cos(kWave * x + phase_) +
                     kSecondAmplitude * kSecondWave * std::cos(kSecondWave * x + second_phase_));
  }
  /// Place `left` metres to the left of the centre line at `x`.
  Eigen::Vector2d beside(double x, double left) const {
    const double angle = heading(x);
    return {x - left * std::sin(angle), y(x) + left * std::cos(angle)};
  }

 private:
  static constexpr double kAmplitude = 12.0;  // [m]
  static constexpr double kWave = 2.0 * M_PI / 170.0;
  static constexpr double kSecondAmplitude = 1.5;  // [m]
  static constexpr double kSecondWave = 2.3 * kWave;

  double phase_, second_phase_;
};

}  // namespace tet_line_tracker
