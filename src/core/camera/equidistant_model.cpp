#include <array>
#include <cmath>
#include <stdexcept>

#include "camera/camera_models.h"
#include "camera/monotonic_root.h"

namespace tet_line_tracker {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Kannala-Brandt: the distance from the principal point is a polynomial of the angle to the optical axis,
///   r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
/// Knows rays beyond 90 degrees.
class EquidistantModel final : public CameraModel {
 public:
  explicit EquidistantModel(const CameraCalibration& calibration) : CameraModel(calibration) {
    for (std::size_t i = 0; i < calibration.distortion.size(); ++i) k_[i] = calibration.distortion[i];
    max_angle_ = endOfMonotonicRange([this](double angle) { return radius(angle).slope; }, 0.001, kPi);
    max_radius_ = radius(max_angle_).value;
  }

  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    const double across = point.head<2>().norm();
    const double angle = std::atan2(across, point.z());
    // At the point opposite to the axis every direction is as good as any other.
    if (!(angle <= max_angle_) || (across == 0.0 && !(point.z() > 0.0))) return std::nullopt;
    const CameraCalibration& c = calibration();
    if (across == 0.0) return Eigen::Vector2d(c.cx, c.cy);
    const Eigen::Vector2d on_plane = point.head<2>() * (radius(angle).value / across);
    return Eigen::Vector2d(c.fx * on_plane.x() + c.cx, c.fy * on_plane.y() + c.cy);
  }

  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    const CameraCalibration& c = calibration();
    const Eigen::Vector2d on_plane((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy);
    const double distance = on_plane.norm();
    if (!(distance <= max_radius_)) return std::nullopt;
    if (distance == 0.0) return Eigen::Vector3d::UnitZ();
    const double angle =
        solveMonotonic([this](double theta) { return radius(theta); }, distance, 0.0, max_angle_);
    if (std::abs(radius(angle).value - distance) > 1e-12) return std::nullopt;
    const Eigen::Vector2d across = on_plane * (std::sin(angle) / distance);
    return Eigen::Vector3d(across.x(), across.y(), std::cos(angle));
  }

 private:
  ValueAndSlope radius(double angle) const {
    const double a2 = angle * angle;
    return {angle * (1.0 + a2 * (k_[0] + a2 * (k_[1] + a2 * (k_[2] + a2 * k_[3])))),
            1.0 + a2 * (3.0 * k_[0] + a2 * (5.0 * k_[1] + a2 * (7.0 * k_[2] + a2 * 9.0 * k_[3])))};
  }

  std::array<double, 4> k_{};
  double max_angle_{0.0};   ///< at which the radius stops to grow, at most pi [rad]
  double max_radius_{0.0};  ///< there, in focal lengths
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
