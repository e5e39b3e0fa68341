#include "silence_warning.h"

#include <ros/master.h>
#include <ros/this_node.h>

#include <set>

namespace tet_line_tracker {

std::string imageTopics(const std::string& own) {
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue answer;
  XmlRpc::XmlRpcValue topics;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "";
  // Not ros::master::getTopics(), which waits until there is a master.
  if (!ros::master::execute("getPublishedTopics", arguments, answer, topics, false)) {
    return "unknown, the master does not answer";
  }
  std::set<std::string> names;
  for (int i = 0; i < topics.size(); ++i) {
    const std::string name = topics[i][0];
    const std::string type = topics[i][1];
    if (name != own && (type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage"))
      names.insert(name);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

std::string topicOfTransport(const std::string& topic, const std::string& transport) {
  return transport == "raw" ? topic : topic + "/" + transport;
}

std::optional<std::string> SilenceWarning::update(bool is_silent, Clock::time_point now) {
  if (!is_silent) {
    due_.reset();
    asked_.reset();
    return std::nullopt;
  }
  if (!asked_) {
    if (!due_.isDue(now)) return std::nullopt;
    asked_ = now;
    // A question from before that still has no answer will do.
    if (!answer_.valid()) answer_ = std::async(std::launch::async, ask_);
    return std::nullopt;
  }
  if (answer_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    asked_.reset();
    return answer_.get();
  }
  if (now - *asked_ < kAnswerTime) return std::nullopt;
  asked_.reset();
  return "unknown, the master does not answer";
}

}  // namespace tet_line_tracker
