#include "tracking/line_depth.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr double kStepNoise = 0.1;   ///< share by which an inverse depth may change from image to image
constexpr double kMinAcross = 1e-6;  ///< where a line moves along itself, its movement tells nothing
constexpr double kMaxVariance = 1e6;
constexpr double kConflictDeviations = 4.0;
constexpr double kMinForwardShare = 0.1;

}  // namespace

LineDepth LineDepth::inUnitOf(double ratio) const {
  LineDepth depth = *this;
  depth.inverse *= ratio;
  depth.variance =
      ratio * ratio * variance + (kStepNoise * kStepNoise * depth.inverse.array().square()).matrix();
  return depth;
}

DepthSensitivity sensitivityOf(const LineStep& step, const Eigen::Vector2d& inverse,
                               const Eigen::Vector3d& translation) {
  const Eigen::Vector3d start = step.start_before + inverse[0] * translation;
  const Eigen::Vector3d end = step.end_before + inverse[1] * translation;
  const Eigen::Vector2d s = start.head<2>() / start.z();
  const Eigen::Vector2d e = end.head<2>() / end.z();
  const Eigen::Vector2d d = (e - s).normalized();
  const Eigen::Vector2d normal(d.y(), -d.x());
  DepthSensitivity sensitivity;
  sensitivity.across[0] = normal.dot(translation.head<2>() - translation.z() * s) / start.z();
  sensitivity.across[1] = normal.dot(translation.head<2>() - translation.z() * e) / end.z();
  return sensitivity;
}

LineDepth measureDepth(const LineStep& step, const Eigen::Vector3d& translation, double sigma) {
  LineDepth depth;
  const Eigen::Vector3d plane = step.start_now.homogeneous().cross(step.end_now.homogeneous()).normalized();
  const double across = plane.dot(translation);
  if (!(std::abs(across) > kMinAcross)) return depth;
  depth.known = true;
  depth.inverse = Eigen::Vector2d(-plane.dot(step.start_before), -plane.dot(step.end_before)) / across;
  depth.across = std::abs(across);
  depth.variance.setConstant(std::min(kMaxVariance, sigma * sigma / (across * across)));
  return depth;
}

bool contradicts(const LineDepth& measured, const LineDepth& expected, bool known, double tolerance) {
  if (!measured.known) return false;
  for (int i = 0; i < 2; ++i) {
    const double least =
        std::max(tolerance / measured.across, kConflictDeviations * std::sqrt(measured.variance[i]));
    if (measured.inverse[i] < -least) return true;
    if (!known || !expected.known) continue;
    const double deviation = std::sqrt(measured.variance[i] + expected.variance[i]);
    if (std::abs(measured.inverse[i] - expected.inverse[i]) >
        std::max(least, kConflictDeviations * deviation)) {
      return true;
    }
  }
  return false;
}

LineDepth fused(const LineDepth& expected, const LineDepth& measured) {
  if (!expected.known) return measured;
  if (!measured.known) return expected;
  LineDepth depth;
  depth.known = true;
  for (int i = 0; i < 2; ++i) {
    const double gain = expected.variance[i] / (expected.variance[i] + measured.variance[i]);
    depth.inverse[i] = expected.inverse[i] + gain * (measured.inverse[i] - expected.inverse[i]);
    depth.variance[i] = (1.0 - gain) * expected.variance[i];
  }
  return depth;
}

LineDepth movedTo(const LineStep& step, const LineDepth& depth, const Eigen::Vector3d& translation) {
  LineDepth moved;
  if (!depth.known) return moved;
  const Eigen::Vector2d inverse = depth.inverse.cwiseMax(0.0);
  const Eigen::Vector3d start = step.start_before + inverse[0] * translation;
  const Eigen::Vector3d end = step.end_before + inverse[1] * translation;
  if (!(start.z() > kMinForwardShare * step.start_before.z() &&
        end.z() > kMinForwardShare * step.end_before.z())) {
    return moved;
  }
  const Eigen::Vector2d at_ends(inverse[0] / start.z(), inverse[1] / end.z());
  const double grown_start = step.start_before.z() / (start.z() * start.z());
  const double grown_end = step.end_before.z() / (end.z() * end.z());
  moved.variance = {grown_start * grown_start * depth.variance[0], grown_end * grown_end * depth.variance[1]};
  // Linear along the image of the line; the ends slide along it.
  const Eigen::Vector2d along = step.end_now - step.start_now;
  const double square = along.squaredNorm();
  const double from = (start.head<2>() / start.z() - step.start_now).dot(along) / square;
  const double to = (end.head<2>() / end.z() - step.start_now).dot(along) / square;
  if (!(to - from > 0.2)) return moved;
  const double slope = (at_ends[1] - at_ends[0]) / (to - from);
  moved.inverse = {std::max(0.0, at_ends[0] - from * slope),
                   std::max(0.0, at_ends[0] + (1.0 - from) * slope)};
  moved.known = moved.inverse.allFinite() && moved.variance.allFinite();
  return moved;
}

}  // namespace tet_line_tracker
