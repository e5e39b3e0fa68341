#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tet_line_tracker {

/// Smooth functions of [0, last], known by their values at equal steps; between these by the cubic polynomial
/// through the four nearest. Several functions of the same argument share its place.
template <std::size_t kFunctions>
class SampledFunctions {
 public:
  using Values = std::array<double, kFunctions>;

  /// Samples `exact`, a function of double that gives Values, in `steps` steps, 3 or more. Trusted from 0 as
  /// far as it is off by at most `tolerance` in the middle between two samples.
  template <class Function>
  SampledFunctions(const Function& exact, double last, std::size_t steps, double tolerance)
      : per_unit_(static_cast<double>(steps) / last) {
    // Nothing is trusted of a range that numbers cannot divide.
    if (!(std::isfinite(last) && std::isfinite(per_unit_) && per_unit_ > 0.0)) return;
    const double step = last / static_cast<double>(steps);
    samples_.reserve(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i) samples_.push_back(exact(static_cast<double>(i) * step));
    trusted_ = static_cast<double>(steps);
    for (std::size_t i = 0; i < steps; ++i) {
      const double middle = static_cast<double>(i) + 0.5;
      const Values is = at(middle / per_unit_);
      const Values should_be = exact(middle * step);
      for (std::size_t k = 0; k < kFunctions; ++k) {
        // Written so that NaN fails.
        if (std::abs(is[k] - should_be[k]) <= tolerance) continue;
        trusted_ = static_cast<double>(i);
        return;
      }
    }
  }

  /// Whether at() may be asked for x, which is 0 or more; false for NaN.
  bool knows(double x) const { return x * per_unit_ < trusted_; }

  Values at(double x) const {
    const double place = x * per_unit_;
    auto i = static_cast<std::size_t>(place);
    // The first and the last step have no neighbour on one side.
    if (i < 1) i = 1;
    if (i + 3 > samples_.size()) i = samples_.size() - 3;
    const double t = place - static_cast<double>(i);
    const double before = t + 1.0;
    const double after = t - 1.0;
    const double beyond = t - 2.0;
    const std::array<double, 4> weights{t * after * beyond / -6.0, before * after * beyond * 0.5,
                                        before * t * beyond * -0.5, before * t * after / 6.0};
    const Values* values = &samples_[i - 1];
    Values sum{};
    for (std::size_t k = 0; k < kFunctions; ++k) {
      for (std::size_t j = 0; j < weights.size(); ++j) sum[k] += weights[j] * values[j][k];
    }
    return sum;
  }

 private:
  double per_unit_;
  double trusted_{0.0};  ///< steps from 0 on
  std::vector<Values> samples_;
};

}  // namespace tet_line_tracker
