#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "camera/camera_models.h"

namespace tet_line_tracker {
namespace {

// Limits that every camera keeps by a wide margin, in multiples of the larger side of its image.
constexpr double kMinFocalSides = 0.05;
constexpr double kMaxFocalSides = 50.0;
constexpr double kMaxCentreSides = 20.0;  // of the principal point from the image, which may be a crop
constexpr double kMaxAspect = 5.0;        // of fx and fy
constexpr int kMaxSide = 100000;          // of an image [px]
// Without an image size [px].
constexpr double kMinFocalPx = 5.0;
constexpr double kMaxFocalPx = 1e6;
constexpr double kMaxCentrePx = 1e5;

/// The image must show something: share of its pixels that can be undistorted to rays in front of the camera.
constexpr double kMinUsableShare = 0.05;
/// Real lenses shrink what is far from the axis, or enlarge it by less than two.
constexpr double kMaxMagnification = 5.0;
constexpr double kMaxFoldedShare = 0.1;

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

std::string listOf(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + sentence(value);
  return text + "]";
}

/// The image, or what its principal point lets one guess; nothing where neither is said.
std::optional<Eigen::Vector2d> imageSize(const CameraCalibration& c) {
  if (c.width > 0 && c.height > 0) return Eigen::Vector2d(c.width, c.height);
  if (c.cx > 1.0 && c.cx < kMaxCentrePx && c.cy > 1.0 && c.cy < kMaxCentrePx) {
    return Eigen::Vector2d(2.0 * c.cx, 2.0 * c.cy);
  }
  return std::nullopt;
}

/// Focal length near the optical axis over fx: mei divides by 1 + xi there.
double axialScale(const CameraCalibration& c) {
  return c.model == "mei" && !c.distortion.empty() ? 1.0 / (1.0 + c.distortion[0]) : 1.0;
}

void checkFinite(const CameraCalibration& c, std::vector<std::string>& broken) {
  const auto require = [&broken](double value, const std::string& field) {
    if (!std::isfinite(value)) broken.push_back(sentence(field, " is ", value, ", needs a finite number"));
  };
  require(c.fx, "fx");
  require(c.fy, "fy");
  require(c.cx, "cx");
  require(c.cy, "cy");
  for (std::size_t i = 0; i < c.distortion.size(); ++i) {
    require(c.distortion[i], sentence("distortion coefficient ", i));
  }
}

void checkIntrinsics(const CameraCalibration& c, std::vector<std::string>& broken) {
  for (const auto& [name, side] : {std::pair{"width", c.width}, {"height", c.height}}) {
    if (side < 0 || side > kMaxSide) {
      broken.push_back(sentence(name, " is ", side, " px, needs 0 (not said) to ", kMaxSide));
    }
  }
  if (c.fx == 0.0 || c.fy == 0.0) {
    broken.push_back(sentence("fx is ", c.fx, " and fy is ", c.fy,
                              ", both must differ from 0 (0 means an uncalibrated camera)"));
    return;
  }
  if (c.fx < 0.0) broken.push_back(sentence("fx is ", c.fx, " px, needs a positive number"));
  if (!broken.empty()) return;

  const std::optional<Eigen::Vector2d> size = imageSize(c);
  const double side = size ? size->maxCoeff() : 0.0;
  const std::string unit = c.width > 0 && c.height > 0
                               ? sentence(" in an image of ", c.width, "x", c.height, " px")
                               : std::string(" (no image size is said)");
  const double low = size ? kMinFocalSides * side : kMinFocalPx;
  const double high = size ? kMaxFocalSides * side : kMaxFocalPx;
  const double scale = axialScale(c);
  for (const auto& [name, focal] : {std::pair{"fx", c.fx}, {"fy", c.fy}}) {
    const double length = std::abs(focal) * scale;
    if (length >= low && length <= high) continue;
    const std::string value = scale == 1.0 ? sentence(name, " is ", focal, " px")
                                           : sentence(name, " / (1 + xi) is ", focal * scale, " px");
    broken.push_back(sentence(value, unit, ", needs ", low, " to ", high));
  }
  const double aspect = std::abs(c.fx / c.fy);
  if (!(aspect <= kMaxAspect && aspect >= 1.0 / kMaxAspect)) {
    broken.push_back(sentence("fx is ", c.fx, " and fy is ", c.fy, " px, needs focal lengths that differ by ",
                              kMaxAspect, " times at most"));
  }
  const double away = size ? kMaxCentreSides * side : kMaxCentrePx;
  for (const auto& [name, centre] : {std::pair{"cx", c.cx}, {"cy", c.cy}}) {
    if (std::abs(centre) <= away) continue;
    broken.push_back(sentence(name, " is ", centre, " px", unit, ", needs ", -away, " to ", away));
  }
}

/// Derivatives of the pixel by the point on z = 1, in focal lengths: the identity for a pinhole. Nothing at
/// the rim of what the model can see.
std::optional<Eigen::Matrix2d> magnification(const CameraModel& model, const Eigen::Vector2d& ideal) {
  const CameraCalibration& c = model.calibration();
  const double step = 1e-5 * (1.0 + ideal.norm());
  Eigen::Matrix2d result;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d offset = step * Eigen::Vector2d::Unit(axis);
    const auto ahead = model.project(Eigen::Vector2d(ideal + offset).homogeneous());
    const auto behind = model.project(Eigen::Vector2d(ideal - offset).homogeneous());
    if (!ahead || !behind) return std::nullopt;
    result.col(axis) = (*ahead - *behind) / (2.0 * step);
  }
  result.row(0) /= c.fx * axialScale(c);
  result.row(1) /= c.fy * axialScale(c);
  return result;
}

void checkDistortion(const CameraModel& model, std::vector<std::string>& broken) {
  const CameraCalibration& c = model.calibration();
  const std::optional<Eigen::Vector2d> size = imageSize(c);
  if (!size) return;
  constexpr int kSamples = 40;  // in each direction
  int usable = 0;
  int folded = 0;
  for (int row = 0; row < kSamples; ++row) {
    for (int column = 0; column < kSamples; ++column) {
      const Eigen::Vector2d fraction((column + 0.5) / kSamples, (row + 0.5) / kSamples);
      const auto ideal = model.normalize(fraction.cwiseProduct(*size));
      if (!ideal) continue;
      ++usable;
      const std::optional<Eigen::Matrix2d> m = magnification(model, *ideal);
      if (!m) continue;
      // Written so that NaN fails. The norm of the identity is the root of two.
      const bool invertible = m->determinant() > 0.0 && m->norm() <= std::sqrt(2.0) * kMaxMagnification;
      folded += invertible ? 0 : 1;
    }
  }
  const double usable_share = static_cast<double>(usable) / (kSamples * kSamples);
  if (usable_share < kMinUsableShare) {
    broken.push_back(sentence(c.model, " with coefficients ", listOf(c.distortion), ", fx ", c.fx, ", cx ",
                              c.cx, ", cy ", c.cy, " can undistort ", std::round(100.0 * usable_share),
                              " % of the image, needs ", 100.0 * kMinUsableShare, " % or more"));
  } else if (folded > kMaxFoldedShare * usable) {
    broken.push_back(sentence(c.model, " with coefficients ", listOf(c.distortion),
                              " folds the image or enlarges it over ", kMaxMagnification, " times at ",
                              std::round(100.0 * folded / usable), " % of its pixels, needs ",
                              100.0 * kMaxFoldedShare, " % or less"));
  }
}

}  // namespace

std::vector<std::string> check(const CameraCalibration& calibration) {
  std::vector<std::string> broken;
  checkFinite(calibration, broken);
  if (broken.empty()) checkIntrinsics(calibration, broken);
  try {
    const std::shared_ptr<const CameraModel> model = makeUncheckedCameraModel(calibration);
    if (broken.empty()) checkDistortion(*model, broken);
  } catch (const std::invalid_argument& error) {
    broken.emplace_back(error.what());
  }
  return broken;
}

}  // namespace tet_line_tracker
