#include "motion/odometry_interpolator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace tet_line_tracker {
namespace {

constexpr double kMaxCoordinate = 1e9;  // [m]
constexpr double kMaxNonOrthogonal = 1e-3;

}  // namespace

void OdometryInterpolator::add(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body) {
  // Written so that NaN fails.
  if (!(odometry_from_body.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate)) return;
  const Eigen::Matrix3d& rotation = odometry_from_body.linear();
  if (!((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kMaxNonOrthogonal)) return;
  samples_.add({stamp_ns, Eigen::Quaterniond(rotation), odometry_from_body.translation()}, kMaxGapNs);
}

std::optional<Eigen::Isometry3d> OdometryInterpolator::poseAt(std::int64_t stamp_ns) const {
  const std::deque<Sample>& samples = samples_.all();
  const auto after =
      std::lower_bound(samples.begin(), samples.end(), stamp_ns,
                       [](const Sample& sample, std::int64_t stamp) { return sample.stamp_ns < stamp; });
  if (after == samples.end()) return std::nullopt;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (after->stamp_ns == stamp_ns) {
    pose.linear() = after->rotation.toRotationMatrix();
    pose.translation() = after->translation;
    return pose;
  }
  if (after == samples.begin()) return std::nullopt;
  const Sample& a = *std::prev(after);
  const Sample& b = *after;
  if (b.stamp_ns - a.stamp_ns > kMaxGapNs) return std::nullopt;
  const double fraction =
      static_cast<double>(stamp_ns - a.stamp_ns) / static_cast<double>(b.stamp_ns - a.stamp_ns);
  pose.linear() = a.rotation.slerp(fraction, b.rotation).toRotationMatrix();
  pose.translation() = a.translation + fraction * (b.translation - a.translation);
  return pose;
}

std::optional<Eigen::Isometry3d> OdometryInterpolator::motion(std::int64_t from_ns,
                                                              std::int64_t to_ns) const {
  if (from_ns >= to_ns) return std::nullopt;
  const std::optional<Eigen::Isometry3d> from = poseAt(from_ns);
  const std::optional<Eigen::Isometry3d> to = poseAt(to_ns);
  if (!from || !to) return std::nullopt;
  const std::deque<Sample>& samples = samples_.all();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const bool inside = samples[i - 1].stamp_ns >= from_ns && samples[i].stamp_ns <= to_ns;
    if (inside && samples[i].stamp_ns - samples[i - 1].stamp_ns > kMaxGapNs) return std::nullopt;
  }
  const Eigen::Isometry3d motion = to->inverse() * *from;
  const double seconds = 1e-9 * static_cast<double>(to_ns - from_ns);
  if (!(motion.translation().norm() <= kMaxSpeed * seconds)) return std::nullopt;
  return motion;
}

}  // namespace tet_line_tracker
