#include "bag_imu.h"

#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>

#include "../ros/imu_input.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

void addFrames(const rosbag::Bag& bag, const char* topic, bool fixed, tf2::BufferCore& frames) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message) continue;
    for (const geometry_msgs::TransformStamped& transform : message->transforms) {
      frames.setTransform(transform, "bag", fixed);
    }
  }
}

std::optional<Eigen::Matrix3d> rotationOfBag(const rosbag::Bag& bag, const std::string& imu_frame,
                                             const std::string& camera_frame) {
  tf2::BufferCore frames;
  addFrames(bag, sequence_bag::kStaticTfTopic, true, frames);
  if (auto rotation = imuRotation(frames, imu_frame, camera_frame)) return rotation;
  addFrames(bag, sequence_bag::kTfTopic, false, frames);
  return imuRotation(frames, imu_frame, camera_frame);
}

}  // namespace

BagImu::BagImu(const rosbag::Bag& bag, std::string topic) : bag_(bag), topic_(std::move(topic)) {
  rosbag::View view(bag, rosbag::TopicQuery(topic_));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<sensor_msgs::Imu>();
    if (!message) continue;
    if (samples_.empty()) frame_ = message->header.frame_id;
    const auto& w = message->angular_velocity;
    samples_.emplace_back(static_cast<std::int64_t>(message->header.stamp.toNSec()),
                          Eigen::Vector3d(w.x, w.y, w.z));
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

void BagImu::setRotation(const std::string& camera_frame, const std::optional<Eigen::Matrix3d>& given,
                         LineTracker& tracker) const {
  const std::optional<Eigen::Matrix3d> rotation = given ? given : rotationOfBag(bag_, frame_, camera_frame);
  if (rotation) {
    tracker.setImuRotation(*rotation);
    return;
  }
  std::fprintf(stderr,
               "warning: %s is not used, as neither /tf_static nor /tf leads from its frame '%s' to the "
               "camera's '%s' and imu_rotation is empty\n",
               topic_.c_str(), frame_.c_str(), camera_frame.c_str());
}

void BagImu::feed(std::int64_t stamp_ns, LineTracker& tracker) {
  while (next_ < samples_.size() && (next_ == 0 || samples_[next_ - 1].first < stamp_ns)) {
    tracker.addAngularVelocity(samples_[next_].first, samples_[next_].second);
    ++next_;
  }
}

}  // namespace tet_line_tracker
