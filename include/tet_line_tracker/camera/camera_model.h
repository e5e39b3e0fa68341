#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace tet_line_tracker {

/// Smallest z of a unit ray whose point on z = 1 an estimator can use: 84.3 degrees from the axis, 10 units
/// out. Further out, a pixel of noise moves the point by more than a line is worth.
constexpr double kMinForward = 0.1;

/// What a camera_info or a calibration file says of a lens.
struct CameraCalibration {
  std::string model;               ///< distortion model as in sensor_msgs/CameraInfo, e.g. "plumb_bob"
  int width{0};                    ///< of the calibrated image [px]; 0: not said
  int height{0};                   ///< of the calibrated image [px]; 0: not said
  double fx{0.0}, fy{0.0};         ///< focal lengths [px]; fy may be negative (ICL-NUIM)
  double cx{0.0}, cy{0.0};         ///< principal point [px]
  std::vector<double> distortion;  ///< coefficients in the order of the model
};

/// Maps between pixels of the raw image and rays of the camera's optical frame (x right, y down, z forward).
/// Const after construction: may be shared between threads.
class CameraModel {
 public:
  virtual ~CameraModel() = default;

  const CameraCalibration& calibration() const { return calibration_; }

  /// Pixel at which a point of the optical frame appears; nothing when the model cannot see it (behind the
  /// camera, or outside the field for which the distortion is invertible). The pixel may lie outside the
  /// image [px].
  virtual std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const = 0;

  /// Unit ray of a pixel; nothing when the undistortion does not converge.
  virtual std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const = 0;

  /// Whether lines that are straight in space may be bent in the image.
  virtual bool bendsLines() const { return true; }

  /// Undistorted point of a pixel on z = 1; nothing when unproject() gives none, or a ray with z below
  /// kMinForward: to the side of the camera or behind it.
  std::optional<Eigen::Vector2d> normalize(const Eigen::Vector2d& pixel) const;

 protected:
  explicit CameraModel(CameraCalibration calibration) : calibration_(std::move(calibration)) {}

 private:
  CameraCalibration calibration_;
};

/// One sentence for each broken rule, with the value seen and what is needed; empty when the calibration can
/// be used. Rules that no real camera breaks: finite numbers, a known model with its number of coefficients,
/// fx > 0, focal lengths of 0.05 to 50 times the larger side of the image that differ by 5 times at most, a
/// principal point within 20 of them, and a distortion that can be undone in 5 % of the image or more and
/// there neither folds it nor enlarges it over 5 times. Without an image size that of twice the principal
/// point.
std::vector<std::string> check(const CameraCalibration& calibration);

/// Model for a calibration. Throws std::invalid_argument with all rules of check() that it breaks. Known,
/// with the order of their coefficients:
/// - plumb_bob: k1 k2 p1 p2 [k3]; also none at all, an ideal pinhole,
/// - rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6 as in OpenCV,
/// - equidistant: k1 k2 k3 k4 (Kannala-Brandt), rays beyond 90 degrees included,
/// - mei: xi k1 k2 p1 p2 (omnidirectional), rays beyond 90 degrees included.
std::shared_ptr<const CameraModel> makeCameraModel(const CameraCalibration& calibration);

}  // namespace tet_line_tracker
