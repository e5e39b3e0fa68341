#include <limits>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {
namespace {

TEST(LineSubscriber, ExamplesOfTheDocumentationCountTheSameTracks) {
  ros::NodeHandle node;
  std::vector<std::string> cpp;
  std::vector<std::string> python;
  const auto listen = [&node](const char* topic, std::vector<std::string>* texts) {
    return node.subscribe<std_msgs::String>(
        topic, 100, [texts](const std_msgs::String::ConstPtr& text) { texts->push_back(text->data); });
  };
  const ros::Subscriber from_cpp = listen("/cpp/summary", &cpp);
  const ros::Subscriber from_python = listen("/python/summary", &python);
  const ros::Publisher lines = node.advertise<LineArray>("/line_tracker/lines", 100);
  const auto waitFor = [](const auto& condition) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(40.0);
    while (ros::ok() && !condition() && ros::WallTime::now() < end) {
      ros::spinOnce();
      ros::WallDuration(0.01).sleep();
    }
    return condition();
  };
  ASSERT_TRUE(waitFor([&] {
    return lines.getNumSubscribers() == 2 && from_cpp.getNumPublishers() == 1 &&
           from_python.getNumPublishers() == 1;
  }));

  // Connections that are counted may still lose their first messages: another epoch goes through first.
  LineArray other;
  other.epoch = 100;
  const auto countBoth = [&] { return cpp.size() + python.size(); };
  ASSERT_TRUE(waitFor([&] {
    lines.publish(other);
    ros::WallDuration(0.1).sleep();
    return !cpp.empty() && !python.empty();
  }));
  for (std::size_t before = 0; before != countBoth();) {
    before = countBoth();
    ros::WallDuration(0.5).sleep();
    ros::spinOnce();
  }
  cpp.clear();
  python.clear();

  for (std::uint32_t i = 0; i < 8; ++i) {
    LineArray array;
    array.epoch = i < 7 ? 0 : 1;
    for (std::uint64_t id = 0; id < 3; ++id) {
      if (id == 1 && i >= 5) continue;  // ends
      Line line;
      line.id = id;
      line.covariance_px = {0.04F, 0.0F, 0.01F};
      if (id == 0 && i == 6) line.covariance_px[2] = std::numeric_limits<float>::quiet_NaN();
      if (id == 2) line.start_normalized[0] = std::numeric_limits<double>::quiet_NaN();
      array.lines.push_back(line);
    }
    lines.publish(array);
  }
  ASSERT_TRUE(waitFor([&] { return cpp.size() >= 8 && python.size() >= 8; }));
  const std::vector<std::string> expected{"2 lines, 0 usable", "2 lines, 0 usable", "2 lines, 0 usable",
                                          "2 lines, 0 usable", "2 lines, 2 usable", "1 lines, 1 usable",
                                          "1 lines, 0 usable", "1 lines, 0 usable"};
  EXPECT_EQ(cpp, expected);
  EXPECT_EQ(python, expected);
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "line_subscriber_test");
  return RUN_ALL_TESTS();
}
