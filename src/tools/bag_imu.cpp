#include "bag_imu.h"

#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "../ros/imu_extrinsic.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

void addTransforms(const rosbag::Bag& bag, const char* topic, bool fixed, tf2::BufferCore& buffer) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message) continue;
    for (const geometry_msgs::TransformStamped& transform : message->transforms) {
      buffer.setTransform(transform, "bag", fixed);
    }
  }
}

std::optional<Eigen::Matrix3d> rotationOfBag(const rosbag::Bag& bag, const std::string& imu_frame,
                                             const std::string& camera_frame) {
  tf2::BufferCore buffer;
  addTransforms(bag, sequence_bag::kStaticTfTopic, true, buffer);
  if (auto rotation = imuRotation(buffer, imu_frame, camera_frame)) return rotation;
  addTransforms(bag, sequence_bag::kTfTopic, false, buffer);
  return imuRotation(buffer, imu_frame, camera_frame);
}

}  // namespace

BagImu::BagImu(const rosbag::Bag& bag, std::string topic) : bag_(bag), topic_(std::move(topic)) {
  std::vector<AngularVelocity> samples;
  rosbag::View view(bag, rosbag::TopicQuery(topic_));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<sensor_msgs::Imu>();
    if (!message) continue;
    if (samples.empty()) frame_ = message->header.frame_id;
    samples.push_back(toAngularVelocity(*message));
  }
  // A bag keeps the order of arrival.
  std::stable_sort(samples.begin(), samples.end(), [](const AngularVelocity& a, const AngularVelocity& b) {
    return a.stamp_ns < b.stamp_ns;
  });
  for (const AngularVelocity& sample : samples) samples_.add(sample);
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

}  // namespace tet_line_tracker
