#include "motion/gyro_integrator.h"

#include <algorithm>

#include "geometry/so3.h"

namespace tet_line_tracker {
namespace {

constexpr std::size_t kMaxSamples = 4000;  // if nobody ever asks

}  // namespace

void GyroIntegrator::add(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  // Written so that NaN fails, and a norm that overflows.
  if (!(angular_velocity.norm() <= kMaxAngularVelocity)) return;
  if (!samples_.empty()) {
    const std::int64_t last = samples_.back().stamp_ns;
    if (stamp_ns < last - kMaxGapNs) {
      samples_.clear();
    } else if (stamp_ns <= last) {
      return;
    }
  }
  samples_.push_back({stamp_ns, angular_velocity});
  if (samples_.size() > kMaxSamples) samples_.pop_front();
}

std::optional<Eigen::Matrix3d> GyroIntegrator::rotation(std::int64_t from_ns, std::int64_t to_ns,
                                                        const Eigen::Vector3d& bias) const {
  if (from_ns >= to_ns || samples_.size() < 2 || samples_.front().stamp_ns > from_ns ||
      samples_.back().stamp_ns < to_ns) {
    return std::nullopt;
  }
  // Of the IMU at the end of each piece, in its frame at `from_ns`.
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    const Sample& a = samples_[i];
    const Sample& b = samples_[i + 1];
    const std::int64_t begin = std::max(from_ns, a.stamp_ns);
    const std::int64_t end = std::min(to_ns, b.stamp_ns);
    if (begin >= end) continue;
    if (b.stamp_ns - a.stamp_ns > kMaxGapNs) return std::nullopt;
    // The velocity in the middle of the piece, linear between the two samples.
    const double middle = 0.5 * static_cast<double>((begin - a.stamp_ns) + (end - a.stamp_ns));
    const double fraction = middle / static_cast<double>(b.stamp_ns - a.stamp_ns);
    const Eigen::Vector3d velocity =
        a.angular_velocity + fraction * (b.angular_velocity - a.angular_velocity) - bias;
    attitude = attitude * Eigen::Quaterniond(so3Exp(velocity * (1e-9 * static_cast<double>(end - begin))));
  }
  // Directions that stay in the world rotate the other way.
  return attitude.conjugate().toRotationMatrix();
}

void GyroIntegrator::forgetBefore(std::int64_t stamp_ns) {
  while (samples_.size() > 2 && samples_[1].stamp_ns <= stamp_ns) samples_.pop_front();
}

}  // namespace tet_line_tracker
