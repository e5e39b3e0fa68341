#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace tet_line_tracker {

/// Radial and tangential distortion of a point on an image plane (Brown-Conrady, with the rational radial
/// factor of OpenCV):
///   radial = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6).
class PlaneDistortion {
 public:
  struct Coefficients {
    double k1{0.0}, k2{0.0}, p1{0.0}, p2{0.0}, k3{0.0}, k4{0.0}, k5{0.0}, k6{0.0};
  };

  explicit PlaneDistortion(const Coefficients& coefficients);

  /// The distorted point, or nothing beyond the radius at which r * radial(r) stops to grow: two ideal points
  /// would share a distorted one there.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& ideal) const;

  /// The ideal point by Newton; nothing when that does not converge to 1e-12, or only beyond the radius
  /// above.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

 private:
  double undistortedRadius(double distorted_radius) const;
  /// An ideal point near that of `distorted`.
  Eigen::Vector2d guess(const Eigen::Vector2d& distorted) const;
  /// Newton from `start`; nothing when it does not arrive inside max_radius_.
  std::optional<Eigen::Vector2d> solve(const Eigen::Vector2d& distorted, const Eigen::Vector2d& start,
                                       int max_iterations) const;
  Eigen::Vector2d apply(const Eigen::Vector2d& p, Eigen::Matrix2d* jacobian) const;

  Coefficients c_;
  double max_radius_;
  bool none_;  ///< all coefficients are 0
  /// Ideal over distorted radius of the radial part alone, at equal steps of the squared distorted radius.
  static constexpr std::size_t kSteps = 128;
  std::array<double, kSteps + 1> ratios_;
  double squares_per_step_{0.0};
};

}  // namespace tet_line_tracker
