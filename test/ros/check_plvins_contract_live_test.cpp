/// check_plvins_contract that is started, and ends, while messages flow.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud.h>

#include <chrono>
#include <deque>
#include <future>

#include "../tools/tool_run.h"

namespace tet_line_tracker {
namespace {

/// Points at 50 Hz, each answered `kBehind` messages later by lines.
class Flow {
 public:
  void step() {
    sensor_msgs::PointCloud cloud;
    cloud.header.frame_id = "world";
    cloud.header.stamp = ros::Time(1000, 20000000 * (count_ % 50)) + ros::Duration(count_ / 50);
    ++count_;
    points_.publish(cloud);
    cloud.channels.resize(3);
    waiting_.push_back(cloud);
    if (waiting_.size() > kBehind) {
      if (count_ != left_out) lines_.publish(waiting_.front());
      waiting_.pop_front();
    }
    ros::WallDuration(0.02).sleep();
  }
  bool isHeard() const { return points_.getNumSubscribers() == 1 && lines_.getNumSubscribers() == 1; }
  int count() const { return count_; }

  int left_out{-1};  ///< count of messages at which no lines are sent

 private:
  static constexpr std::size_t kBehind = 10;

  ros::NodeHandle node_;
  ros::Publisher points_{node_.advertise<sensor_msgs::PointCloud>("/feature_tracker/feature", 100)};
  ros::Publisher lines_{node_.advertise<sensor_msgs::PointCloud>("/linefeature_tracker/linefeature", 100)};
  std::deque<sensor_msgs::PointCloud> waiting_;
  int count_{0};
};

class CheckPlVinsContractLive : public ::testing::Test {
 protected:
  /// The judge from the middle of the flow on for 3 s; with `gap` one message of lines is left out meanwhile.
  ToolRun judge(bool gap) {
    for (int i = 0; i < 50; ++i) flow_.step();
    auto run = std::async(std::launch::async, [] {
      return runTool("check_plvins_contract", {"--seconds", "3"});
    });
    int heard = 0;
    while (run.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      flow_.step();
      if (flow_.isHeard() && ++heard == 50 && gap) flow_.left_out = flow_.count() + 1;
    }
    return run.get();
  }

  Flow flow_;
};

TEST_F(CheckPlVinsContractLive, FindsNothingInAGoodStreamThatBeganBeforeAndGoesOn) {
  const ToolRun run = judge(false);
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  EXPECT_NE(run.output.find(", 0 broken rules"), std::string::npos) << run.output;
}

TEST_F(CheckPlVinsContractLive, FindsTheMessageThatIsMissingMeanwhile) {
  const ToolRun run = judge(true);
  EXPECT_EQ(run.status, 1) << run.output << run.errors;
  EXPECT_NE(run.output.find("missing_message 1\n"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(", 1 broken rules"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "check_plvins_contract_live_test");
  ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
