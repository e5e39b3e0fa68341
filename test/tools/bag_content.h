#pragma once

#include <string>
#include <vector>

#include <ros/time.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <Eigen/Geometry>

#include <geometry_msgs/Pose.h>

namespace tet_line_tracker {

template <class Message>
struct Recorded {
  ros::Time bag_time;
  Message message;
};

/// All messages of a topic in the order of their bag time.
template <class Message>
std::vector<Recorded<Message>> readTopic(const std::string& path, const std::string& topic) {
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  std::vector<Recorded<Message>> result;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto message = instance.instantiate<Message>();
    if (message) result.push_back({instance.getTime(), *message});
  }
  return result;
}

inline Eigen::Isometry3d toPose(const geometry_msgs::Pose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.orientation;
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

}  // namespace tet_line_tracker
