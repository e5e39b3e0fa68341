#include "motion/gyro_integrator.h"

#include <algorithm>

#include "geometry/so3.h"

namespace tet_line_tracker {
void GyroIntegrator::add(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  // Written so that NaN fails, and a norm that overflows.
  if (!(angular_velocity.norm() <= kMaxAngularVelocity)) return;
  samples_.add({stamp_ns, angular_velocity}, kMaxGapNs);
}

std::optional<Eigen::Matrix3d> GyroIntegrator::rotation(std::int64_t from_ns, std::int64_t to_ns,
                                                        const Eigen::Vector3d& bias) const {
  const std::deque<Sample>& samples = samples_.all();
  if (from_ns >= to_ns || samples.size() < 2 || samples.front().stamp_ns > from_ns ||
      samples.back().stamp_ns < to_ns) {
    return std::nullopt;
  }
  // Of the IMU at the end of each piece, in its frame at `from_ns`.
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Sample& a = samples[i];
    const Sample& b = samples[i + 1];
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

}  // namespace tet_line_tracker
