/// Simulated time that does not run, runs, stands still and jumps back: a bag that is played with and without
/// --clock, paused, and looped.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Imu.h>

#include <memory>

#include "managed_nodelet.h"
#include "node_stream.h"
#include "stream_diagnostics.h"

namespace tet_line_tracker {
namespace {

/// A player of a bag with images and an IMU, faster than real time.
class SimTime : public ::testing::Test {
 protected:
  void SetUp() override {
    ros::param::set("/simulated/queue_size", 1000);
    ros::param::set("/simulated/imu_rotation", "0 0 0 1");
    nodelet_ = std::make_unique<ManagedNodelet>("simulated");
    ASSERT_TRUE(nodelet_->isLoaded());
    clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    imu_ = node_.advertise<sensor_msgs::Imu>("/simulated/imu", 1000);
    stream_ = std::make_unique<Stream>("simulated");
    ASSERT_TRUE(stream_->connected());
    ASSERT_TRUE(waitFor([this] { return imu_.getNumSubscribers() == 1; }));
  }
  void play(int first, int last, bool with_clock) {
    ros::WallRate rate(60.0);
    for (int i = first; i < last; ++i) {
      if (with_clock) {
        rosgraph_msgs::Clock clock;
        clock.clock = kStart + kPeriod * i;
        clock_.publish(clock);
      }
      sensor_msgs::Imu message;
      message.header.frame_id = "imu";
      message.header.stamp = kStart + kPeriod * i;
      imu_.publish(message);
      stream_->sendPictures(i, i + 1);
      ros::spinOnce();
      rate.sleep();
    }
  }
  std::uint32_t lastEpoch() const { return stream_->lines.back().epoch; }

  ManagerLog log_;
  ros::NodeHandle node_;
  ros::Publisher clock_, imu_;
  std::unique_ptr<ManagedNodelet> nodelet_;
  std::unique_ptr<Stream> stream_;
};

TEST_F(SimTime, TracksWithoutAClockThroughAPauseAndOverALoop) {
  play(0, 20, false);
  ASSERT_TRUE(stream_->receives(20)) << stream_->lines.size();
  EXPECT_TRUE(log_.holds({"images had no pose within"})) << "the mapper tells, though its clock stands still";
  EXPECT_EQ(stream_->lines.back().lines.at(0).age, 20U);

  const std::uint32_t epoch = lastEpoch();
  ASSERT_TRUE(waitFor([&] { return stream_->summary.find("no image for") == 0; },
                      StreamDiagnostics::kSilence + kPatience))
      << stream_->summary;
  EXPECT_TRUE(log_.holds({"no image for", "/simulated/image"}));
  play(20, 30, false);
  ASSERT_TRUE(stream_->receives(30)) << stream_->lines.size();
  EXPECT_EQ(lastEpoch(), epoch) << "stamps went on where they stood";
  EXPECT_EQ(stream_->lines.back().lines.at(0).age, 30U);
  EXPECT_TRUE(waitFor([&] { return stream_->summary.find("no image for") != 0; }));

  play(0, 20, false);  // two images tell that the bag begins again
  ASSERT_TRUE(stream_->receives(48)) << stream_->lines.size();
  EXPECT_EQ(lastEpoch(), epoch + 1);
}

TEST_F(SimTime, TracksWithAClockThatJumpsBackWithTheBag) {
  for (int turn = 0; turn < 3; ++turn) {
    play(0, 30, true);
    const std::size_t images = turn == 0 ? 30 : 30 + 28U * static_cast<unsigned>(turn);
    ASSERT_TRUE(stream_->receives(images)) << stream_->lines.size() << " in turn " << turn;
    EXPECT_EQ(lastEpoch(), stream_->lines.front().epoch + static_cast<unsigned>(turn));
  }
  expectContiguousIds(stream_->lines);
  EXPECT_EQ(log_.count({"out of step"}), 0);
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "sim_time_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
