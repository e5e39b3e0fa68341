#include <array>
#include <cmath>
#include <stdexcept>

#include "camera/camera_models.h"
#include "camera/monotonic_root.h"
#include "camera/sampled_functions.h"

namespace tet_line_tracker {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kSamples = 2048;  ///< over 1 - cos(angle), and over the squared radius
constexpr double kTolerance = 1e-11;    ///< of the samples, in focal lengths and in the length of a ray

/// Kannala-Brandt: the distance from the principal point is a polynomial of the angle to the optical axis,
///   r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
/// Knows rays beyond 90 degrees. Both ways go through samples of what takes an arc tangent one way, and
/// iterations and a sine the other; where the samples are too coarse, towards the ends of the range, exactly.
class EquidistantModel final : public CameraModel {
 public:
  explicit EquidistantModel(const CameraCalibration& calibration)
      : CameraModel(calibration),
        k_(coefficients(calibration)),
        max_angle_(endOfMonotonicRange([this](double angle) { return radius(angle).slope; }, 0.001, kPi)),
        max_radius_(radius(max_angle_).value),
        min_cosine_(std::cos(max_angle_)),
        scales_([this](double from_axis) { return std::array<double, 1>{scaleAt(from_axis)}; },
                1.0 - min_cosine_, kSamples, kTolerance),
        rays_([this](double squared_radius) { return rayAt(std::sqrt(squared_radius)); },
              max_radius_ * max_radius_, kSamples, kTolerance) {}

  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    const double length = point.norm();
    const double cosine = point.z() / length;
    // Written so that NaN fails.
    if (!(cosine >= min_cosine_)) return std::nullopt;
    const double from_axis = 1.0 - cosine;
    double scale;  // radius over the distance from the axis
    if (scales_.knows(from_axis)) {
      scale = scales_.at(from_axis)[0] / length;
    } else {
      const double across = point.head<2>().norm();
      // At the point opposite to the axis every direction is as good as any other.
      if (!(across > 0.0 || point.z() > 0.0)) return std::nullopt;
      scale = across > 0.0 ? radius(std::atan2(across, point.z())).value / across : 0.0;
    }
    const CameraCalibration& c = calibration();
    return Eigen::Vector2d(c.fx * (scale * point.x()) + c.cx, c.fy * (scale * point.y()) + c.cy);
  }

  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    const CameraCalibration& c = calibration();
    const Eigen::Vector2d on_plane((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy);
    const double squared_radius = on_plane.squaredNorm();
    if (!(squared_radius <= max_radius_ * max_radius_)) return std::nullopt;
    const auto [across, forward] =
        rays_.knows(squared_radius) ? rays_.at(squared_radius) : rayAt(std::sqrt(squared_radius));
    return Eigen::Vector3d(across * on_plane.x(), across * on_plane.y(), forward).normalized();
  }

 private:
  static std::array<double, 4> coefficients(const CameraCalibration& calibration) {
    std::array<double, 4> k{};
    for (std::size_t i = 0; i < calibration.distortion.size(); ++i) k[i] = calibration.distortion[i];
    return k;
  }

  /// Radius over sine of the angle at which 1 - cosine is `from_axis`.
  double scaleAt(double from_axis) const {
    if (!(from_axis > 0.0)) return 1.0;
    const double angle = 2.0 * std::asin(std::sqrt(std::fmin(0.5 * from_axis, 1.0)));
    return radius(angle).value / std::sqrt(from_axis * (2.0 - from_axis));
  }

  /// Of the ray that is seen at a radius: sine of its angle over the radius, and cosine.
  std::array<double, 2> rayAt(double distance) const {
    if (!(distance > 0.0)) return {1.0, 1.0};
    const double angle =
        solveMonotonic([this](double theta) { return radius(theta); }, distance, 0.0, max_angle_);
    return {std::sin(angle) / distance, std::cos(angle)};
  }

  ValueAndSlope radius(double angle) const {
    const double a2 = angle * angle;
    return {angle * (1.0 + a2 * (k_[0] + a2 * (k_[1] + a2 * (k_[2] + a2 * k_[3])))),
            1.0 + a2 * (3.0 * k_[0] + a2 * (5.0 * k_[1] + a2 * (7.0 * k_[2] + a2 * 9.0 * k_[3])))};
  }

  std::array<double, 4> k_;
  double max_angle_;            ///< at which the radius stops to grow, at most pi [rad]
  double max_radius_;           ///< there, in focal lengths
  double min_cosine_;           ///< there
  SampledFunctions<1> scales_;  ///< scaleAt()
  SampledFunctions<2> rays_;    ///< rayAt(), over the squared radius
};

}  // namespace

std::shared_ptr<const CameraModel> makeEquidistantModel(const CameraCalibration& calibration) {
  const std::size_t n = calibration.distortion.size();
  if (n != 0 && n != 4) {
    throw std::invalid_argument("equidistant has " + std::to_string(n) +
                                " distortion coefficients, needs 0 or 4");
  }
  return std::make_shared<EquidistantModel>(calibration);
}

}  // namespace tet_line_tracker
