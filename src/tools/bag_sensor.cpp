#include "bag_sensor.h"

#include <rosbag/view.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "../ros/sensor_extrinsic.h"
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

std::optional<Eigen::Isometry3d> poseOfBag(const rosbag::Bag& bag, const std::string& sensor_frame,
                                           const std::string& camera_frame) {
  tf2::BufferCore buffer;
  addTransforms(bag, sequence_bag::kStaticTfTopic, true, buffer);
  if (auto pose = sensorPose(buffer, sensor_frame, camera_frame)) return pose;
  addTransforms(bag, sequence_bag::kTfTopic, false, buffer);
  return sensorPose(buffer, sensor_frame, camera_frame);
}

}  // namespace

template <class Message>
BagSensor<Message>::BagSensor(const rosbag::Bag& bag, std::string topic)
    : bag_(bag), topic_(std::move(topic)) {
  std::vector<Sample> samples;
  rosbag::View view(bag, rosbag::TopicQuery(topic_));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<Message>();
    if (!message) continue;
    if (samples.empty()) frame_ = frameOf(*message);
    samples.push_back(toSample(*message));
  }
  // A bag keeps the order of arrival.
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.stamp_ns < b.stamp_ns; });
  for (const Sample& sample : samples) samples_.add(sample);
}

template <class Message>
std::optional<Eigen::Isometry3d> BagSensor<Message>::findPose(const std::string& camera_frame,
                                                              const std::optional<Eigen::Isometry3d>& given,
                                                              const char* parameter) const {
  std::optional<Eigen::Isometry3d> pose = given ? given : poseOfBag(bag_, frame_, camera_frame);
  if (!pose) {
    std::fprintf(stderr,
                 "warning: %s is not used, as neither /tf_static nor /tf leads from its frame '%s' to the "
                 "camera's '%s' and %s is empty\n",
                 topic_.c_str(), frame_.c_str(), camera_frame.c_str(), parameter);
  }
  return pose;
}

template class BagSensor<sensor_msgs::Imu>;
template class BagSensor<nav_msgs::Odometry>;

}  // namespace tet_line_tracker
