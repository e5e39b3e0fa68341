#include <cmath>
#include <stdexcept>

#include "camera/camera_models.h"
#include "camera/plane_distortion.h"

namespace tet_line_tracker {
namespace {

/// Mei and Rives: a ray meets the unit sphere, is seen from a point `xi` behind its centre on the plane z =
/// 1, and is distorted there. Knows rays beyond 90 degrees when xi > 0.
class MeiModel final : public CameraModel {
 public:
  explicit MeiModel(const CameraCalibration& calibration)
      : CameraModel(calibration),
        xi_(calibration.distortion[0]),
        distortion_({calibration.distortion[1], calibration.distortion[2], calibration.distortion[3],
                     calibration.distortion[4]}) {}

  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    const double length = point.norm();
    if (!(length > 0.0)) return std::nullopt;
    const Eigen::Vector3d ray = point / length;
    // Seen from a point outside the sphere (xi > 1), the far side is hidden behind the near one; from a point
    // inside, everything behind that point is.
    const double lowest_z = xi_ > 1.0 ? -1.0 / xi_ : -xi_;
    if (!(ray.z() > lowest_z)) return std::nullopt;
    const std::optional<Eigen::Vector2d> distorted = distortion_.distort(ray.head<2>() / (ray.z() + xi_));
    if (!distorted) return std::nullopt;
    const CameraCalibration& c = calibration();
    return Eigen::Vector2d(c.fx * distorted->x() + c.cx, c.fy * distorted->y() + c.cy);
  }

  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    const CameraCalibration& c = calibration();
    const std::optional<Eigen::Vector2d> m =
        distortion_.undistort({(pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy});
    if (!m) return std::nullopt;
    const double r2 = m->squaredNorm();
    const double under_root = 1.0 + (1.0 - xi_ * xi_) * r2;
    if (!(under_root >= 0.0)) return std::nullopt;  // the pixel sees past the sphere
    const double scale = (xi_ + std::sqrt(under_root)) / (1.0 + r2);
    return Eigen::Vector3d(scale * m->x(), scale * m->y(), scale - xi_).normalized();
  }

 private:
  double xi_;
  PlaneDistortion distortion_;
};

}  // namespace

std::shared_ptr<const CameraModel> makeMeiModel(const CameraCalibration& calibration) {
  if (calibration.distortion.size() != 5) {
    throw std::invalid_argument("mei has " + std::to_string(calibration.distortion.size()) +
                                " distortion coefficients, needs 5 (xi k1 k2 p1 p2)");
  }
  if (calibration.distortion[0] < 0.0) {
    throw std::invalid_argument("xi of mei is " + std::to_string(calibration.distortion[0]) +
                                ", needs 0 or more");
  }
  return std::make_shared<MeiModel>(calibration);
}

}  // namespace tet_line_tracker
