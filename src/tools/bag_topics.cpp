#include "bag_topics.h"

#include <nav_msgs/Odometry.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include <iterator>
#include <set>
#include <stdexcept>

#include "bag_reader.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

using Topics = std::set<std::string>;

template <class Message>
Topics topicsOf(const rosbag::Bag& bag) {
  Topics topics;
  rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<Message>()));
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) topics.insert(connection->topic);
  return topics;
}

std::string listOf(const Topics& topics) {
  std::string list;
  for (const std::string& topic : topics) list += (list.empty() ? "" : ", ") + topic;
  return list.empty() ? "none" : list;
}

/// Everything in the bag with its type, for people.
std::string contentOf(const rosbag::Bag& bag) {
  Topics content;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    content.insert(connection->topic + " (" + connection->datatype + ")");
  }
  return listOf(content);
}

bool endsWith(const std::string& text, const std::string& tail) {
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

std::string severalTopics(const rosbag::Bag& bag, const Topics& topics, const std::string& what,
                          const std::string& option) {
  return bag.getFileName() + " has " + std::to_string(topics.size()) + " topics with " + what + " (" +
         listOf(topics) + "): name one with " + option;
}

void requireTopic(const rosbag::Bag& bag, const Topics& topics, const std::string& asked,
                  const std::string& type) {
  if (topics.count(asked) != 0) return;
  throw std::runtime_error(bag.getFileName() + " has no topic " + asked + " with " + type +
                           "; it has: " + listOf(topics));
}

/// camera_info of an image by the convention of image_transport: its neighbour.
std::string neighbour(std::string image_topic) {
  if (endsWith(image_topic, "/compressed")) image_topic.resize(image_topic.rfind('/'));
  return image_topic.substr(0, image_topic.rfind('/') + 1) + "camera_info";
}

template <class Message>
std::string chooseOnlyTopic(const rosbag::Bag& bag, const std::string& asked, const char* type) {
  const Topics topics = topicsOf<Message>(bag);
  if (!asked.empty()) requireTopic(bag, topics, asked, type);
  std::string topic = asked.empty() && topics.size() == 1 ? *topics.begin() : asked;
  checkDefinition<Message>(bag, topic);
  return topic;
}

}  // namespace

std::string chooseImageTopic(const rosbag::Bag& bag, const std::string& asked) {
  Topics raw = topicsOf<sensor_msgs::Image>(bag);
  Topics compressed = topicsOf<sensor_msgs::CompressedImage>(bag);
  std::string topic = asked;
  if (!asked.empty()) {
    Topics all = raw;
    all.insert(compressed.begin(), compressed.end());
    requireTopic(bag, all, asked, "sensor_msgs/Image or CompressedImage");
  } else {
    raw.erase(sequence_bag::kDepthTopic);
    for (auto i = compressed.begin(); i != compressed.end();) {
      i = endsWith(*i, "/compressedDepth") ? compressed.erase(i) : std::next(i);
    }
    const Topics& topics = raw.empty() ? compressed : raw;
    if (topics.empty()) {
      throw std::runtime_error(
          bag.getFileName() +
          " has no images (sensor_msgs/Image or CompressedImage); it has: " + contentOf(bag));
    }
    if (topics.size() > 1) throw std::runtime_error(severalTopics(bag, topics, "images", "--image"));
    topic = *topics.begin();
  }
  checkDefinition<sensor_msgs::Image>(bag, topic);
  checkDefinition<sensor_msgs::CompressedImage>(bag, topic);
  return topic;
}

std::string chooseCameraInfoTopic(const rosbag::Bag& bag, const std::string& asked,
                                  const std::string& image_topic) {
  const Topics topics = topicsOf<sensor_msgs::CameraInfo>(bag);
  std::string topic = asked;
  if (!asked.empty()) {
    requireTopic(bag, topics, asked, "sensor_msgs/CameraInfo");
  } else if (topics.size() == 1) {
    topic = *topics.begin();
  } else if (topics.size() > 1) {
    topic = neighbour(image_topic);
    if (topics.count(topic) == 0) {
      throw std::runtime_error(severalTopics(bag, topics, "sensor_msgs/CameraInfo", "--camera-info"));
    }
  }
  checkDefinition<sensor_msgs::CameraInfo>(bag, topic);
  return topic;
}

std::string chooseImuTopic(const rosbag::Bag& bag, const std::string& asked) {
  return chooseOnlyTopic<sensor_msgs::Imu>(bag, asked, "sensor_msgs/Imu");
}

std::string chooseOdometryTopic(const rosbag::Bag& bag, const std::string& asked) {
  std::string topic = chooseOnlyTopic<nav_msgs::Odometry>(bag, asked, "nav_msgs/Odometry");
  if (topic.empty()) {
    const Topics topics = topicsOf<nav_msgs::Odometry>(bag);
    throw std::runtime_error(
        bag.getFileName() + " has " + std::to_string(topics.size()) + " topics of type nav_msgs/Odometry (" +
        listOf(topics) + "), prior=odometry needs one" + (topics.empty() ? "" : ": name it with --odometry"));
  }
  return topic;
}

}  // namespace tet_line_tracker
