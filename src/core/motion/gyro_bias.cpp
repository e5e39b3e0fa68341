#include "motion/gyro_bias.h"

#include <algorithm>

namespace tet_line_tracker {
namespace {

constexpr float kInnovationGain = 0.2F;  ///< of an image in the mean of the innovations

constexpr float kMaxNoticed = 0.1F;  ///< larger innovations count as this [rad/s]

}  // namespace

void GyroBias::notice(float innovation) {
  // Written so that NaN counts as the largest.
  const float size = innovation < kMaxNoticed ? innovation : kMaxNoticed;
  mean_innovation_ += kInnovationGain * (size - mean_innovation_);
}

void GyroBias::learn(const Eigen::Vector3f& measured, const Eigen::Vector3f& seen, float interval_s) {
  const Eigen::Vector3f innovation = (measured - seen) / interval_s - value_;
  const float size = innovation.norm();
  notice(size);
  // Written so that NaN fails, as without an interval.
  if (!(size <= kMaxInnovation) || !(interval_s > 0.0F)) return;
  learned_s_ = std::min(learned_s_ + interval_s, kTimeConstant);
  const float gain = std::min(1.0F, interval_s / learned_s_);
  const bool clipped = learned_s_ > kSettlingTime && size > kClippedInnovation;
  value_ += (clipped ? gain * kClippedInnovation / size : gain) * innovation;
}

}  // namespace tet_line_tracker
