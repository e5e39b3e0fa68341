#include "camera/plane_distortion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "camera/monotonic_root.h"

namespace tet_line_tracker {
namespace {

/// Rays further out than this (89.4 degrees) are of no use on a plane.
constexpr double kLargestRadius = 100.0;
/// Within it the table of ratios is made: 63 degrees from the axis, where there is no distortion.
constexpr double kTableRadius = 2.0;

/// The radial factor over r^2, and its derivative by r^2.
ValueAndSlope radialFactor(const PlaneDistortion::Coefficients& c, double r2) {
  const double numerator = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double denominator = 1.0 + r2 * (c.k4 + r2 * (c.k5 + r2 * c.k6));
  const double numerator_slope = c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3);
  const double denominator_slope = c.k4 + r2 * (2.0 * c.k5 + r2 * 3.0 * c.k6);
  const double factor = numerator / denominator;
  return {factor, (numerator_slope - factor * denominator_slope) / denominator};
}

/// Derivative of r * radial(r) by r.
double radialSlope(const PlaneDistortion::Coefficients& c, double r) {
  // Past a zero of the denominator the model has jumped to another branch.
  if (1.0 + r * r * (c.k4 + r * r * (c.k5 + r * r * c.k6)) <= 0.0) return -1.0;
  const ValueAndSlope factor = radialFactor(c, r * r);
  return factor.value + 2.0 * r * r * factor.slope;
}

}  // namespace

PlaneDistortion::PlaneDistortion(const Coefficients& coefficients)
    : c_(coefficients),
      max_radius_(
          endOfMonotonicRange([&](double r) { return radialSlope(coefficients, r); }, 0.01, kLargestRadius)),
      none_(c_.k1 == 0.0 && c_.k2 == 0.0 && c_.p1 == 0.0 && c_.p2 == 0.0 && c_.k3 == 0.0 && c_.k4 == 0.0 &&
            c_.k5 == 0.0 && c_.k6 == 0.0) {
  const double last = std::min(kTableRadius, max_radius_ * radialFactor(c_, max_radius_ * max_radius_).value);
  squares_per_step_ = last * last / static_cast<double>(kSteps);
  ratios_[0] = 1.0;
  for (std::size_t i = 1; i <= kSteps; ++i) {
    const double radius = std::sqrt(squares_per_step_ * static_cast<double>(i));
    ratios_[i] = undistortedRadius(radius) / radius;
  }
}

double PlaneDistortion::undistortedRadius(double distorted_radius) const {
  return solveMonotonic(
      [this](double r) {
        const ValueAndSlope factor = radialFactor(c_, r * r);
        return ValueAndSlope{r * factor.value, factor.value + 2.0 * r * r * factor.slope};
      },
      distorted_radius, 0.0, max_radius_);
}

Eigen::Vector2d PlaneDistortion::guess(const Eigen::Vector2d& distorted) const {
  const double place = distorted.squaredNorm() / squares_per_step_;
  // Written so that NaN fails.
  if (!(place < static_cast<double>(kSteps))) return distorted;
  const auto i = static_cast<std::size_t>(place);
  return (ratios_[i] + (place - static_cast<double>(i)) * (ratios_[i + 1] - ratios_[i])) * distorted;
}

std::optional<Eigen::Vector2d> PlaneDistortion::distort(const Eigen::Vector2d& ideal) const {
  if (!(ideal.norm() <= max_radius_)) return std::nullopt;
  return apply(ideal, nullptr);
}

std::optional<Eigen::Vector2d> PlaneDistortion::undistort(const Eigen::Vector2d& distorted) const {
  if (none_) {
    if (!(distorted.norm() <= max_radius_)) return std::nullopt;
    return distorted;
  }
  // Newton from nearby nearly always arrives; inside max_radius_ there is one solution only.
  if (auto ideal = solve(distorted, guess(distorted), 8)) return ideal;
  // The radial part alone has one solution and is solved safely; Newton in the plane then has only the small
  // tangential part left to find, and cannot run to another branch.
  const double distorted_radius = distorted.norm();
  if (!(distorted_radius < kLargestRadius)) return std::nullopt;
  const double scale = distorted_radius > 0.0 ? undistortedRadius(distorted_radius) / distorted_radius : 1.0;
  return solve(distorted, scale * distorted, 30);
}

std::optional<Eigen::Vector2d> PlaneDistortion::solve(const Eigen::Vector2d& distorted,
                                                      const Eigen::Vector2d& start,
                                                      int max_iterations) const {
  constexpr double kTolerance = 1e-7;  // the step taken from there squares the error
  Eigen::Vector2d ideal = start;
  for (int i = 0; i < max_iterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = apply(ideal, &jacobian) - distorted;
    if (std::abs(jacobian.determinant()) < 1e-12) return std::nullopt;
    ideal -= jacobian.inverse() * error;
    if (!(ideal.norm() <= 2.0 * max_radius_)) return std::nullopt;
    if (error.norm() < kTolerance) {
      if (ideal.norm() > max_radius_) return std::nullopt;
      return ideal;
    }
  }
  return std::nullopt;
}

Eigen::Vector2d PlaneDistortion::apply(const Eigen::Vector2d& p, Eigen::Matrix2d* jacobian) const {
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const ValueAndSlope radial = radialFactor(c_, r2);
  if (jacobian != nullptr) {
    const double slope = 2.0 * radial.slope;
    (*jacobian)(0, 0) = radial.value + slope * x * x + 2.0 * c_.p1 * y + 6.0 * c_.p2 * x;
    (*jacobian)(0, 1) = slope * x * y + 2.0 * c_.p1 * x + 2.0 * c_.p2 * y;
    (*jacobian)(1, 0) = (*jacobian)(0, 1);
    (*jacobian)(1, 1) = radial.value + slope * y * y + 6.0 * c_.p1 * y + 2.0 * c_.p2 * x;
  }
  return {x * radial.value + 2.0 * c_.p1 * x * y + c_.p2 * (r2 + 2.0 * x * x),
          y * radial.value + c_.p1 * (r2 + 2.0 * y * y) + 2.0 * c_.p2 * x * y};
}

}  // namespace tet_line_tracker
