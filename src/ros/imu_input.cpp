#include "imu_input.h"

#include <tf2/exceptions.h>
#include <Eigen/Geometry>

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kJumpNs = 100000000;  // back by more than this: not a late message
constexpr std::size_t kMaxSamples = 4000;    // of a stretch, and
constexpr std::size_t kMaxStretches = 4;     // if no image comes

}  // namespace

std::optional<Eigen::Matrix3d> imuRotation(const tf2::BufferCore& frames, const std::string& imu_frame,
                                           const std::string& camera_frame) {
  try {
    const auto q = frames.lookupTransform(camera_frame, imu_frame, ros::Time(0)).transform.rotation;
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

std::optional<Eigen::Matrix3d> imuRotation(const std::string& quaternion) {
  if (quaternion.empty()) return std::nullopt;
  std::istringstream text(quaternion);
  Eigen::Quaterniond q;
  std::string rest;
  if (!(text >> q.x() >> q.y() >> q.z() >> q.w()) || text >> rest || !(std::abs(q.norm() - 1.0) < 0.01)) {
    throw std::invalid_argument("parameter imu_rotation is " + quaternion +
                                ", needs a unit quaternion qx qy qz qw");
  }
  return q.normalized().toRotationMatrix();
}

void ImuInput::add(const sensor_msgs::Imu& message) {
  const auto& w = message.angular_velocity;
  const Sample sample{static_cast<std::int64_t>(message.header.stamp.toNSec()), {w.x, w.y, w.z}};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    frame_ = message.header.frame_id;
    silent_ = false;
    if (stretches_.empty()) stretches_.emplace_back();
    if (!stretches_.back().empty()) {
      const std::int64_t last = stretches_.back().back().stamp_ns;
      if (sample.stamp_ns < last - kJumpNs) {
        stretches_.emplace_back();
      } else if (sample.stamp_ns <= last) {
        return;
      }
    } else if (last_fed_ && sample.stamp_ns < last_fed_->stamp_ns - kJumpNs) {
      stretches_.emplace_back();
    }
    stretches_.back().push_back(sample);
    if (stretches_.back().size() > kMaxSamples) stretches_.back().pop_front();
    if (stretches_.size() > kMaxStretches) leaveStretch();
  }
  arrived_.notify_all();
}

bool ImuInput::waitFor(std::int64_t stamp_ns, double patience_s) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto settled = [&] {
    leaveOldStretches(stamp_ns);
    return covers(stamp_ns) || stretches_.size() > 1;  // nothing is added to a complete stretch
  };
  if (!settled() && !silent_) {
    silent_ = true;
    arrived_.wait_for(lock, std::chrono::duration<double>(patience_s), settled);
  }
  return covers(stamp_ns);
}

void ImuInput::feed(std::int64_t stamp_ns, LineTracker& tracker) {
  const std::lock_guard<std::mutex> lock(mutex_);
  leaveOldStretches(stamp_ns);
  if (stretches_.empty()) return;
  Stretch& stretch = stretches_.front();
  while (!stretch.empty() && !(last_fed_ && last_fed_->stamp_ns >= stamp_ns)) {
    last_fed_ = stretch.front();
    stretch.pop_front();
    tracker.addAngularVelocity(last_fed_->stamp_ns, last_fed_->angular_velocity);
  }
}

std::optional<std::string> ImuInput::frame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return frame_;
}

/// An image of the time after a jump back makes the messages from before it worthless.
void ImuInput::leaveOldStretches(std::int64_t stamp_ns) {
  while (stretches_.size() > 1) {
    const Stretch& stretch = stretches_.front();
    const std::optional<std::int64_t> first =
        last_fed_ ? last_fed_->stamp_ns
                  : (stretch.empty() ? std::nullopt : std::optional<std::int64_t>(stretch.front().stamp_ns));
    if (first && stamp_ns >= *first - kJumpNs) return;
    leaveStretch();
  }
}

void ImuInput::leaveStretch() {
  stretches_.pop_front();
  last_fed_.reset();
}

bool ImuInput::covers(std::int64_t stamp_ns) const {
  if (last_fed_ && last_fed_->stamp_ns >= stamp_ns) return true;
  return !stretches_.empty() && !stretches_.front().empty() && stretches_.front().back().stamp_ns >= stamp_ns;
}

}  // namespace tet_line_tracker
