/// Parameters that change while images come, as rqt_reconfigure and dynparam change them.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <unistd.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <future>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>

#include "../core/shell_command.h"
#include "managed_nodelet.h"
#include "node_stream.h"

namespace tet_line_tracker {
namespace {

namespace scene = synthetic_scene;

/// A file of this process that is removed in the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& ending)
      : path_(testing::TempDir() + "reconfigure_test_" + std::to_string(getpid()) + ending) {}
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A tracker /NAME that gets an image at a time.
class TunedTracker {
 public:
  explicit TunedTracker(const std::string& name) : name_(name), nodelet_(name), stream_(name) {
    updates_ = node_.subscribe<dynamic_reconfigure::Config>(
        "/" + name + "/parameter_updates", 100,
        [this](const dynamic_reconfigure::Config::ConstPtr& config) { update = *config; });
  }
  bool ready() {
    return nodelet_.isLoaded() && stream_.connected() && waitFor([this] { return !update.ints.empty(); });
  }
  ManagedNodelet& nodelet() { return nodelet_; }
  Stream& stream() { return stream_; }
  bool reload() { return nodelet_.unload() && nodelet_.load() && stream_.connected(); }

  /// What the tracker makes of the next image. Fails the test when it makes nothing of it.
  const LineArray& next() {
    const std::size_t before = stream_.lines.size();
    stream_.send(scene::cameraInfo(kStart + kPeriod * image_));
    stream_.sendPictures(image_, image_ + 1);
    ++image_;
    EXPECT_TRUE(stream_.receives(before + 1)) << "image " << image_;
    return stream_.lines.back();
  }
  const TrackingStatistics& nextStatistics() {
    next();
    return stream_.statistics.back();
  }
  /// Sends an image of which no message is expected.
  void skip() {
    stream_.sendPictures(image_, image_ + 1);
    ++image_;
  }

  void set(const std::string& name, int value) { change(&dynamic_reconfigure::Config::ints, name, value); }
  void set(const std::string& name, double value) {
    change(&dynamic_reconfigure::Config::doubles, name, value);
  }
  void set(const std::string& name, bool value) { change(&dynamic_reconfigure::Config::bools, name, value); }
  void set(const std::string& name, const char* value) {
    change(&dynamic_reconfigure::Config::strs, name, value);
  }

  dynamic_reconfigure::Config update;  ///< the latest that was published

 private:
  template <class Parameter, class Value>
  void change(std::vector<Parameter> dynamic_reconfigure::Config::*list, const std::string& name,
              const Value& value) {
    dynamic_reconfigure::Reconfigure request;
    (request.request.config.*list).emplace_back();
    (request.request.config.*list).back().name = name;
    (request.request.config.*list).back().value = value;
    EXPECT_TRUE(ros::service::call("/" + name_ + "/set_parameters", request)) << name;
  }

  std::string name_;
  ros::NodeHandle node_;
  ManagedNodelet nodelet_;
  Stream stream_;
  ros::Subscriber updates_;
  int image_{0};
};

double lengthOf(const Line& line) {
  return std::hypot(line.end_px[0] - line.start_px[0], line.end_px[1] - line.start_px[1]);
}

bool isInside(const Line& line, float left, float top, float right, float bottom) {
  const auto inside = [&](float x, float y) { return x >= left && x <= right && y >= top && y <= bottom; };
  return inside(line.start_px[0], line.start_px[1]) && inside(line.end_px[0], line.end_px[1]);
}

template <class Condition>
std::size_t count(const LineArray& message, const Condition& condition) {
  return static_cast<std::size_t>(std::count_if(message.lines.begin(), message.lines.end(), condition));
}

TEST(Reconfigure, TwelveChangesHaveTheirEffectInTheNextImage) {
  TunedTracker tracker("tuned");
  ASSERT_TRUE(tracker.ready());
  for (int i = 0; i < 4; ++i) tracker.next();
  const std::set<std::uint64_t> ids = idsOf(tracker.next());
  ASSERT_GE(ids.size(), 20U);

  const auto shorter = [](const Line& line) { return lengthOf(line) < 48.0; };
  ASSERT_GE(count(tracker.next(), shorter), 5U);
  tracker.set("min_length", 48.0);
  EXPECT_EQ(count(tracker.next(), shorter), 0U);
  EXPECT_EQ(tracker.next().epoch, 0U);
  tracker.set("min_length", 30.0);

  tracker.set("border", 30.0);
  const auto in_border = [](const Line& line) { return !isInside(line, 30.0F, 30.0F, 289.0F, 209.0F); };
  EXPECT_EQ(count(tracker.next(), in_border), 0U);
  tracker.set("border", 2.0);

  ASSERT_EQ(tracker.nextStatistics().prior, "image");
  tracker.set("prior", "none");
  EXPECT_EQ(tracker.nextStatistics().prior, "none");

  tracker.set("imu_time_offset", "0.125");
  tracker.set("prior", "auto");
  EXPECT_EQ(tracker.nextStatistics().imu_time_offset, 0.125F);

  const TemporaryFile mask(".png");
  cv::Mat left(scene::kHeight, scene::kWidth, CV_8UC1, cv::Scalar(0));
  left.colRange(0, 160).setTo(255);
  ASSERT_TRUE(cv::imwrite(mask.path(), left));
  tracker.set("mask", mask.path().c_str());
  const auto at_right = [](const Line& line) { return line.start_px[0] > 165.0F && line.end_px[0] > 165.0F; };
  EXPECT_EQ(count(tracker.next(), at_right), 0U);
  tracker.set("mask", "");
  EXPECT_TRUE(waitFor([&] { return count(tracker.next(), at_right) > 0; }));

  ros::NodeHandle node;
  std::size_t texts = 0;
  const ros::Subscriber markers = node.subscribe<visualization_msgs::MarkerArray>(
      "/tuned/markers", 10, [&](const visualization_msgs::MarkerArray::ConstPtr& array) {
        for (const auto& marker : array->markers) texts += marker.text.empty() ? 0U : 1U;
      });
  ASSERT_TRUE(waitFor([&] { return markers.getNumPublishers() == 1; }));
  tracker.set("marker_ids", true);
  tracker.next();
  EXPECT_TRUE(waitFor([&] { return texts > 0; }));

  tracker.set("max_joint_residual", 0.001);
  EXPECT_GT(tracker.nextStatistics().lost_residual, 0U);
  tracker.set("max_joint_residual", 0.1);

  tracker.set("publish_rate", 10.0);
  tracker.next();
  tracker.skip();
  const std::uint64_t image = tracker.next().image_count;
  tracker.skip();
  EXPECT_EQ(tracker.next().image_count, image + 2);
  tracker.set("publish_rate", 0.0);
  EXPECT_EQ(tracker.next().epoch, 0U);

  tracker.set("max_gap", 0.04);
  EXPECT_EQ(tracker.next().epoch, 1U);
  tracker.set("max_gap", 1.0);

  tracker.set("max_lines", 31);
  tracker.set("min_lines", 7);
  tracker.set("max_lines", 7);
  tracker.set("window_px", 9);
  const LineArray& after = tracker.next();
  EXPECT_EQ(after.epoch, 2U);
  EXPECT_EQ(after.image_count, 1U);
  EXPECT_EQ(after.lines.size(), 7U);

  tracker.set("method", "paper");
  EXPECT_EQ(tracker.next().epoch, 3U);
  const LineArray& second = tracker.next();
  ASSERT_FALSE(second.lines.empty());
  EXPECT_TRUE(std::isnan(second.lines[0].sigma_px));

  EXPECT_TRUE(waitFor([&] { return tracker.stream().diagnostics["images dropped: queue"] == "0"; }));
  expectContiguousIds(tracker.stream().lines);
}

TEST(Reconfigure, WhatIsRefusedIsLoggedWithTheReasonAndReportedAsItWas) {
  const ManagerLog log;
  TunedTracker tracker("refusing");
  ASSERT_TRUE(tracker.ready());
  tracker.next();
  const auto offered = [&](const std::string& name) {
    for (const auto& parameter : tracker.update.strs) {
      if (parameter.name == name) return parameter.value;
    }
    for (const auto& parameter : tracker.update.ints) {
      if (parameter.name == name) return std::to_string(parameter.value);
    }
    return "no " + name;
  };
  tracker.set("max_lines", 5000);
  EXPECT_TRUE(log.holds({"refused: parameter max_lines is 5000, needs a whole number in 1..1000"}));
  tracker.set("min_lines", 400);
  EXPECT_TRUE(log.holds({"refused: parameter min_lines is 400, needs at most max_lines, which is 150"}));
  tracker.set("imu_rotation", "0 0 0 1");
  EXPECT_TRUE(log.holds({"refused: parameter imu_rotation is set at the start only"}));
  tracker.set("maxlines", 100);
  EXPECT_TRUE(log.holds({"refused: parameter maxlines is not known; did you mean max_lines?"}));
  tracker.set("mask", "/no/such/mask.png");
  EXPECT_TRUE(log.holds({"refused: ", "/no/such/mask.png"}));
  tracker.update = dynamic_reconfigure::Config();
  tracker.set("window_px", 8);
  EXPECT_TRUE(log.holds({"refused: parameter window_px is 8"}));
  ASSERT_TRUE(waitFor([&] { return !tracker.update.ints.empty(); }));
  EXPECT_EQ(offered("max_lines"), "150");
  EXPECT_EQ(offered("min_lines"), "30");
  EXPECT_EQ(offered("window_px"), "7");
  EXPECT_EQ(offered("imu_rotation"), "");
  EXPECT_EQ(offered("mask"), "");
  EXPECT_EQ(tracker.next().epoch, 0U);
  EXPECT_FALSE(ros::param::has("/refusing/max_lines"));
}

/// The command line tool of dynamic_reconfigure.
ShellResult dynparam(const std::string& arguments) {
  return runShell("timeout 60 rosrun dynamic_reconfigure dynparam " + arguments);
}

TEST(Reconfigure, DynparamListsGetsSetsDumpsAndLoadsWhileImagesComeAndNoneIsLost) {
  ros::param::set("/commanded/queue_size", 1000);
  TunedTracker tracker("commanded");
  ASSERT_TRUE(tracker.ready());
  const TemporaryFile dump(".yaml");
  const auto commands = std::async(std::launch::async, [&] {
    const ShellResult list = dynparam("list");
    EXPECT_NE(list.output.find("/commanded\n"), std::string::npos) << list.output;
    EXPECT_EQ(dynparam("dump /commanded " + dump.path()).status, 0);
    for (const char* change :
         {"min_length 40", "\"{'max_lines': 100, 'prior': 'image', 'check_depth': false}\""}) {
      const ShellResult set = dynparam(std::string("set /commanded ") + change);
      EXPECT_EQ(set.status, 0) << set.output;
    }
    const ShellResult get = dynparam("get /commanded");
    for (const char* value : {"'min_length': 40.0", "'max_lines': 100", "'prior': 'image'",
                              "'check_depth': False", "'window_px': 7"}) {
      EXPECT_NE(get.output.find(value), std::string::npos) << value << " is not in " << get.output;
    }
  });
  int sent = 0;
  while (commands.wait_for(std::chrono::seconds(0)) != std::future_status::ready || sent < 20) {
    tracker.stream().sendPictures(sent, sent + 1);
    ++sent;
    EXPECT_TRUE(tracker.stream().receives(static_cast<std::size_t>(sent)));
    ros::WallDuration(0.03).sleep();
  }
  EXPECT_EQ(tracker.stream().lines.size(), static_cast<std::size_t>(sent));
  expectContiguousIds(tracker.stream().lines);
  EXPECT_EQ(tracker.stream().lines.back().epoch, 0U);
  double min_length = 0.0;
  EXPECT_TRUE(ros::param::get("/commanded/min_length", min_length));
  EXPECT_EQ(min_length, 40.0);

  ASSERT_TRUE(tracker.reload());
  const ShellResult again = dynparam("get /commanded");
  EXPECT_NE(again.output.find("'min_length': 40.0"), std::string::npos)
      << "a node that starts again has the values of the one before: " << again.output;
  const ShellResult load = dynparam("load /commanded " + dump.path());
  if (load.output.find("could not determine a constructor for the tag") != std::string::npos)
    GTEST_SKIP() << "the dynparam of this system, as of Debian 11, cannot load what it has dumped";
  EXPECT_EQ(load.status, 0) << load.output;
  const ShellResult loaded = dynparam("get /commanded");
  EXPECT_NE(loaded.output.find("'min_length': 30.0"), std::string::npos) << loaded.output;
  EXPECT_NE(loaded.output.find("'prior': 'auto'"), std::string::npos) << loaded.output;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "reconfigure_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
