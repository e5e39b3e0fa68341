#include <algorithm>
#include <stdexcept>
#include <vector>

#include "camera/camera_models.h"
#include "camera/plane_distortion.h"

namespace tet_line_tracker {
namespace {

PlaneDistortion::Coefficients plumbBobCoefficients(const std::vector<double>& d) {
  const std::size_t n = d.size();
  if (n != 0 && n != 4 && n != 5) {
    throw std::invalid_argument("plumb_bob has " + std::to_string(n) +
                                " distortion coefficients, needs 0, 4 or 5");
  }
  PlaneDistortion::Coefficients c;
  if (n >= 4) c = {d[0], d[1], d[2], d[3]};
  if (n == 5) c.k3 = d[4];
  return c;
}

PlaneDistortion::Coefficients rationalCoefficients(const std::vector<double>& d) {
  const std::size_t n = d.size();
  if (n != 8 && n != 12 && n != 14) {
    throw std::invalid_argument("rational_polynomial has " + std::to_string(n) +
                                " distortion coefficients, needs 8 (or 12 or 14 with zeros after the 8th)");
  }
  for (std::size_t i = 8; i < n; ++i) {
    if (d[i] == 0.0) continue;
    throw std::invalid_argument("rational_polynomial has " + std::to_string(d[i]) +
                                " as distortion coefficient " + std::to_string(i) +
                                "; the thin prism (s1..s4) and tilt of OpenCV are not supported, only zeros");
  }
  return {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7]};
}

/// Pinhole: rays meet the plane z = 1, are distorted there, and scaled to pixels.
class PinholeModel final : public CameraModel {
 public:
  PinholeModel(const CameraCalibration& calibration, const PlaneDistortion::Coefficients& coefficients)
      : CameraModel(calibration), distortion_(coefficients) {}

  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    if (!(point.z() > 0.0)) return std::nullopt;
    const std::optional<Eigen::Vector2d> distorted = distortion_.distort(point.head<2>() / point.z());
    if (!distorted) return std::nullopt;
    const CameraCalibration& c = calibration();
    return Eigen::Vector2d(c.fx * distorted->x() + c.cx, c.fy * distorted->y() + c.cy);
  }

  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    const CameraCalibration& c = calibration();
    const std::optional<Eigen::Vector2d> ideal =
        distortion_.undistort({(pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy});
    if (!ideal) return std::nullopt;
    return Eigen::Vector3d(ideal->x(), ideal->y(), 1.0).normalized();
  }

  bool bendsLines() const override {
    const std::vector<double>& d = calibration().distortion;
    return std::any_of(d.begin(), d.end(), [](double coefficient) { return coefficient != 0.0; });
  }

 private:
  PlaneDistortion distortion_;
};

}  // namespace

std::shared_ptr<const CameraModel> makePinholeModel(const CameraCalibration& calibration) {
  return std::make_shared<PinholeModel>(calibration, calibration.model == "rational_polynomial"
                                                         ? rationalCoefficients(calibration.distortion)
                                                         : plumbBobCoefficients(calibration.distortion));
}

}  // namespace tet_line_tracker
