#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/CompressedImage.h>

#include "synthetic_scene.h"
#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/TrackingStatistics.h"
#include "wait_for.h"

namespace tet_line_tracker {

inline const ros::Time kStart(1000, 0);
inline const ros::Duration kPeriod(0.05);

/// What the node /manager has logged since this object was made.
class ManagerLog {
 public:
  ManagerLog() {
    subscriber_ = node_.subscribe<rosgraph_msgs::Log>("/rosout", 1000,
                                                      [this](const rosgraph_msgs::Log::ConstPtr& message) {
                                                        if (message->name == "/manager")
                                                          lines_.push_back(message->msg);
                                                      });
  }
  /// Lines with all of `words`.
  int count(const std::vector<std::string>& words) const {
    return static_cast<int>(std::count_if(lines_.begin(), lines_.end(), [&](const std::string& line) {
      return std::all_of(words.begin(), words.end(),
                         [&](const std::string& word) { return line.find(word) != std::string::npos; });
    }));
  }
  /// Waits until there is a line with all of `words`.
  bool holds(const std::vector<std::string>& words) const {
    return waitFor([&] { return count(words) > 0; });
  }

 private:
  ros::NodeHandle node_;
  std::vector<std::string> lines_;
  ros::Subscriber subscriber_;
};

/// One nodelet /NAME, its image topic /NAME/image and everything it says.
class Stream {
 public:
  enum class Images { kRaw, kCompressed };

  explicit Stream(const std::string& name, Images images = Images::kRaw) : name_(name) {
    const std::string topic = "/" + name + "/image";
    image_publisher_ = images == Images::kRaw
                           ? node_.advertise<sensor_msgs::Image>(topic, 300)
                           : node_.advertise<sensor_msgs::CompressedImage>(topic + "/compressed", 300);
    info_publisher_ = node_.advertise<sensor_msgs::CameraInfo>("/" + name + "/camera_info", 10);
    lines_subscriber_ = node_.subscribe<LineArray>(
        "/" + name + "/lines", 300, [this](const LineArray::ConstPtr& m) { lines.push_back(*m); });
    statistics_subscriber_ = node_.subscribe<TrackingStatistics>(
        "/" + name + "/statistics", 300,
        [this](const TrackingStatistics::ConstPtr& m) { statistics.push_back(*m); });
    diagnostics_subscriber_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 300, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& m) { take(*m); });
  }

  bool connected() {
    return waitFor([this] {
      return image_publisher_.getNumSubscribers() == 1 && info_publisher_.getNumSubscribers() == 1 &&
             lines_subscriber_.getNumPublishers() == 1 && statistics_subscriber_.getNumPublishers() == 1 &&
             diagnostics_subscriber_.getNumPublishers() >= 1;
    });
  }
  void send(const sensor_msgs::Image& image) { image_publisher_.publish(image); }
  void send(const sensor_msgs::CompressedImage& image) { image_publisher_.publish(image); }
  void send(const sensor_msgs::CameraInfo& info) { info_publisher_.publish(info); }
  /// Pictures `first` to before `last` at their time of a 20 Hz camera.
  void sendPictures(int first, int last) {
    for (int i = first; i < last; ++i) send(synthetic_scene::monoMessage(i, kStart + kPeriod * i));
  }
  bool receives(std::size_t messages) {
    return waitFor([&] { return lines.size() >= messages && statistics.size() >= messages; });
  }
  std::vector<LineArray> lines;
  std::vector<TrackingStatistics> statistics;
  std::map<std::string, std::string> diagnostics;  ///< the latest values of this nodelet
  std::string summary;                             ///< the latest one of its diagnostics
  int diagnostics_count{0};

 private:
  void take(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) {
      if (status.name.find(name_ + ":") == std::string::npos) continue;
      ++diagnostics_count;
      summary = status.message;
      for (const auto& value : status.values) diagnostics[value.key] = value.value;
    }
  }

  std::string name_;
  ros::NodeHandle node_;
  ros::Publisher image_publisher_, info_publisher_;
  ros::Subscriber lines_subscriber_, statistics_subscriber_, diagnostics_subscriber_;
};

inline std::set<std::uint64_t> idsOf(const LineArray& message) {
  std::set<std::uint64_t> ids;
  for (const Line& line : message.lines) ids.insert(line.id);
  return ids;
}

/// No id twice in a message, none that comes back after it was missing.
inline void expectContiguousIds(const std::vector<LineArray>& messages) {
  std::set<std::uint64_t> before;
  std::set<std::uint64_t> gone;
  std::uint32_t epoch = 0;
  for (const LineArray& message : messages) {
    const std::set<std::uint64_t> ids = idsOf(message);
    EXPECT_EQ(ids.size(), message.lines.size());
    if (message.epoch != epoch) {
      before.clear();
      gone.clear();
    }
    for (const std::uint64_t id : ids) EXPECT_EQ(gone.count(id), 0U) << "id " << id << " came back";
    for (const std::uint64_t id : before) {
      if (ids.count(id) == 0) gone.insert(id);
    }
    before = ids;
    epoch = message.epoch;
  }
}

}  // namespace tet_line_tracker
