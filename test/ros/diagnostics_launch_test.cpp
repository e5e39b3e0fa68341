/// diagnostics.launch gathers what a tracker reports in one branch of the tree of all diagnostics.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <pluginlib/class_loader.hpp>

#include <map>
#include <string>

#include "managed_nodelet.h"
#include "node_stream.h"

namespace tet_line_tracker {
namespace {

/// Debian 11 has an aggregator that looks for its library in the wrong folder.
bool findsItsAnalyzers() {
  struct Analyzer {};
  pluginlib::ClassLoader<Analyzer> loader("diagnostic_aggregator", "diagnostic_aggregator::Analyzer");
  return !loader.getClassLibraryPath("diagnostic_aggregator/GenericAnalyzer").empty();
}

TEST(DiagnosticsLaunch, GathersTheReportOfATrackerUnderLines) {
  if (!findsItsAnalyzers())
    GTEST_SKIP() << "the diagnostic_aggregator of this system does not find its own library";
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> gathered;
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics_agg", 10, [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
        for (const auto& status : array->status) gathered[status.name] = status;
      });
  const ManagedNodelet nodelet("watched");
  ASSERT_TRUE(nodelet.isLoaded());
  const std::string name = "/Lines/watched: line tracking";
  ASSERT_TRUE(waitFor([&] { return gathered.count(name) == 1; }));
  EXPECT_EQ(gathered[name].message, "waiting for the first image");
  EXPECT_EQ(gathered["/Lines"].level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_FALSE(gathered[name].values.empty());
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "diagnostics_launch_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
