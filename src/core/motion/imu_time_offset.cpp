#include "motion/imu_time_offset.h"

#include <algorithm>
#include <cmath>

#include "motion/gyro_integrator.h"

namespace tet_line_tracker {
namespace {

constexpr std::size_t kMaxSamples = 4000;  // if no image comes
constexpr std::size_t kMaxWaiting = 100;   // if no sample comes
constexpr double kMinImages = 30.0;        // before anything is said
constexpr double kMaxResidual = 1.0;       // a larger one at every offset is a wrong rotation [rad/s]
constexpr double kGain = 0.2;              // share of the way to a new estimate per image
constexpr std::size_t kWide = 3;           // candidates to each side that tell the curvature

}  // namespace

void ImuTimeOffset::addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  // Written so that NaN fails.
  if (!(angular_velocity.norm() <= GyroIntegrator::kMaxAngularVelocity)) return;
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    if (stamp_ns < last.stamp_ns - GyroIntegrator::kMaxGapNs) {
      samples_.clear();
      waiting_.clear();
    } else if (stamp_ns <= last.stamp_ns) {
      return;
    } else {
      const double interval_s = 1e-9 * static_cast<double>(stamp_ns - last.stamp_ns);
      angle = last.angle + 0.5 * interval_s * (last.angular_velocity + angular_velocity);
    }
  }
  samples_.push_back({stamp_ns, angular_velocity, angle});
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  while (!waiting_.empty() && waiting_.front().to_ns + kReachNs <= stamp_ns) {
    learn(waiting_.front());
    waiting_.pop_front();
  }
  const std::int64_t needed_ns =
      (waiting_.empty() ? stamp_ns - 1000000000 : waiting_.front().from_ns) - kReachNs;
  while (samples_.size() > 2 && samples_[1].stamp_ns <= needed_ns) samples_.pop_front();
}

void ImuTimeOffset::addImageRotation(std::int64_t from_ns, std::int64_t to_ns, const Eigen::Vector3d& seen,
                                     const Eigen::Matrix3d& camera_from_imu) {
  if (!seen.allFinite() || to_ns <= from_ns) return;
  const Interval interval{from_ns, to_ns, seen, camera_from_imu};
  if (!samples_.empty() && samples_.back().stamp_ns >= to_ns + kReachNs) {
    learn(interval);
    return;
  }
  waiting_.push_back(interval);
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

/// Integral of the angular velocity, linear between samples. The samples reach before and beyond `stamp_ns`.
Eigen::Vector3d ImuTimeOffset::angleAt(std::int64_t stamp_ns) const {
  auto after =
      std::lower_bound(samples_.begin(), samples_.end(), stamp_ns,
                       [](const Sample& sample, std::int64_t stamp) { return sample.stamp_ns < stamp; });
  if (after == samples_.begin()) return after->angle;
  const auto before = after - 1;
  const double gap_s = 1e-9 * static_cast<double>(after->stamp_ns - before->stamp_ns);
  const double time_s = 1e-9 * static_cast<double>(stamp_ns - before->stamp_ns);
  return before->angle + time_s * before->angular_velocity +
         0.5 * time_s * time_s / gap_s * (after->angular_velocity - before->angular_velocity);
}

bool ImuTimeOffset::hasGap(std::int64_t from_ns, std::int64_t to_ns) const {
  if (samples_.empty() || samples_.front().stamp_ns > from_ns || samples_.back().stamp_ns < to_ns)
    return true;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (samples_[i].stamp_ns <= from_ns || samples_[i - 1].stamp_ns >= to_ns) continue;
    if (samples_[i].stamp_ns - samples_[i - 1].stamp_ns > GyroIntegrator::kMaxGapNs) return true;
  }
  return false;
}

void ImuTimeOffset::learn(const Interval& interval) {
  if (hasGap(interval.from_ns - kReachNs, interval.to_ns + kReachNs)) return;
  const double interval_s = 1e-9 * static_cast<double>(interval.to_ns - interval.from_ns);
  std::array<Eigen::Vector3d, kCandidates> differences;
  double smallest = kMaxResidual;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const std::int64_t offset_ns = offsetOf(i);
    const Eigen::Vector3d turn = angleAt(interval.to_ns + offset_ns) - angleAt(interval.from_ns + offset_ns);
    // Directions that stay in the world rotate the other way.
    differences[i] = (interval.seen + interval.camera_from_imu * turn) / interval_s;
    const Eigen::Vector3d mean =
        weight_ > 0.0 ? Eigen::Vector3d(moments_[i].sum / weight_) : Eigen::Vector3d::Zero();
    smallest = std::min(smallest, (differences[i] - mean).norm());
  }
  // One weight for all candidates; before the bias is known it is that of all images alike.
  const double weight = smallest < kMaxResidual ? 1.0 / (1.0 + std::pow(smallest / kResidualScale, 2)) : 0.0;
  const double kept = std::exp(-interval_s / kTimeConstant);
  weight_ = kept * weight_ + weight;
  images_ = kept * images_ + (weight > 0.0 ? 1.0 : 0.0);
  for (std::size_t i = 0; i < kCandidates; ++i) {
    Moments& moments = moments_[i];
    moments.sum = kept * moments.sum + weight * differences[i];
    moments.square_sum = kept * moments.square_sum + weight * differences[i].squaredNorm();
  }
  estimate();
}

double ImuTimeOffset::variance(std::size_t candidate) const {
  const Moments& moments = moments_[candidate];
  return moments.square_sum / weight_ - (moments.sum / weight_).squaredNorm();
}

void ImuTimeOffset::estimate() {
  sigma_s_.reset();
  if (images_ < kMinImages || !(weight_ > 0.0)) return;
  std::size_t best = 0;
  for (std::size_t i = 1; i < kCandidates; ++i) {
    if (variance(i) < variance(best)) best = i;
  }
  if (best < kWide || best + kWide >= kCandidates) return;
  const double least = variance(best);
  const double left = variance(best - 1);
  const double right = variance(best + 1);
  const double bend = left + right - 2.0 * least;
  const double wide_bend = variance(best - kWide) + variance(best + kWide) - 2.0 * least;
  if (!(bend > 0.0 && wide_bend > 0.0)) return;
  const double step_s = 1e-9 * static_cast<double>(kStepNs);
  const double estimate_s = 1e-9 * static_cast<double>(offsetOf(best)) + 0.5 * step_s * (left - right) / bend;
  // Of a least squares fit of one offset to three residuals per image.
  const double information = wide_bend / (2.0 * std::pow(static_cast<double>(kWide) * step_s, 2));
  sigma_s_ = std::sqrt(std::max(least, 0.0) / (3.0 * images_ * information));
  if (*sigma_s_ > kMaxSigma || std::abs(estimate_s) > kMaxOffset) return;
  if (std::abs(estimate_s - value_s_) > kDeadBand) value_s_ += kGain * (estimate_s - value_s_);
}

}  // namespace tet_line_tracker
