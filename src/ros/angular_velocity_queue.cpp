#include "angular_velocity_queue.h"

namespace tet_line_tracker {

AngularVelocity toAngularVelocity(const sensor_msgs::Imu& message) {
  const auto& w = message.angular_velocity;
  return {static_cast<std::int64_t>(message.header.stamp.toNSec()), {w.x, w.y, w.z}};
}

void AngularVelocityQueue::add(const AngularVelocity& sample) {
  if (sample.stamp_ns == 0) return;
  const std::optional<std::int64_t> last = newest();
  if (!last || sample.stamp_ns > *last) waiting_.push_back(sample);
}

void AngularVelocityQueue::keepNewest(std::size_t size) {
  while (waiting_.size() > size) waiting_.pop_front();
}

void AngularVelocityQueue::feed(std::int64_t stamp_ns, LineTracker& tracker) {
  while (!waiting_.empty() && !(last_fed_ns_ && *last_fed_ns_ >= stamp_ns)) {
    const AngularVelocity& sample = waiting_.front();
    tracker.addAngularVelocity(sample.stamp_ns, sample.rad_per_s);
    last_fed_ns_ = sample.stamp_ns;
    waiting_.pop_front();
  }
}

bool AngularVelocityQueue::covers(std::int64_t stamp_ns) const {
  const std::optional<std::int64_t> last = newest();
  return last && *last >= stamp_ns;
}

std::optional<std::int64_t> AngularVelocityQueue::oldest() const {
  if (last_fed_ns_ || waiting_.empty()) return last_fed_ns_;
  return waiting_.front().stamp_ns;
}

std::optional<std::int64_t> AngularVelocityQueue::newest() const {
  if (waiting_.empty()) return last_fed_ns_;
  return waiting_.back().stamp_ns;
}

}  // namespace tet_line_tracker
