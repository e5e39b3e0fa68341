#include "motion/gyro_bias.h"

#include <algorithm>

namespace tet_line_tracker {

void GyroBias::learn(const Eigen::Vector3f& measured, const Eigen::Vector3f& seen, float interval_s) {
  const Eigen::Vector3f innovation = (measured - seen) / interval_s - value_;
  const float size = innovation.norm();
  // Written so that NaN fails, as without an interval.
  if (!(size <= kMaxInnovation) || !(interval_s > 0.0F)) return;
  learned_s_ = std::min(learned_s_ + interval_s, kTimeConstant);
  const float gain = std::min(1.0F, interval_s / learned_s_);
  const bool clipped = learned_s_ > kSettlingTime && size > kClippedInnovation;
  value_ += (clipped ? gain * kClippedInnovation / size : gain) * innovation;
}

}  // namespace tet_line_tracker
