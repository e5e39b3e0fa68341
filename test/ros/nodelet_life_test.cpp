/// Loading and unloading, resets, subscribers that stand still, and drivers that come and go, all while
/// images come.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "managed_nodelet.h"
#include "node_stream.h"

namespace tet_line_tracker {
namespace {

namespace scene = synthetic_scene;

/// A subscriber of ~lines and ~debug_image in a process of its own, which can be stopped.
class OtherProcess {
 public:
  explicit OtherProcess(const std::string& name) : process_(fork()) {
    if (process_ != 0) return;
    execl("/proc/self/exe", "nodelet_life_test", "subscribe", name.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  ~OtherProcess() {
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  void freeze() const { ::kill(process_, SIGSTOP); }

 private:
  pid_t process_;
};

TEST(NodeletLife, FiftyLoadsAndUnloadsAtOneHundredTwentyFiveImagesPerSecond) {
  ros::NodeHandle node;
  ros::Publisher images = node.advertise<sensor_msgs::Image>("/reloaded/image", 10);
  std::size_t received = 0;
  const ros::Subscriber lines =
      node.subscribe<LineArray>("/reloaded/lines", 1000, [&](const LineArray::ConstPtr&) { ++received; });
  int image = 0;
  const ros::WallTimer camera =
      node.createWallTimer(ros::WallDuration(0.008), [&](const ros::WallTimerEvent&) {
        images.publish(scene::monoMessage(image, kStart + ros::Duration(0.008) * image));
        ++image;
      });
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ManagedNodelet nodelet("reloaded");
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(nodelet.isLoaded()) << i;
    // Sometimes in the middle of the first image, sometimes later.
    ros::WallDuration(0.005 * (i % 10)).sleep();
    ASSERT_TRUE(nodelet.unload()) << i;
    ASSERT_TRUE(nodelet.load()) << i;
  }
  spinner.stop();
  const std::size_t before = received;
  EXPECT_TRUE(waitFor([&] { return received > before + 20; })) << "the last one tracks";
}

TEST(NodeletLife, ResetsAtFiftyPerSecondLoseNoImage) {
  ros::param::set("/often_reset/queue_size", 1000);
  const ManagedNodelet nodelet("often_reset");
  ASSERT_TRUE(nodelet.isLoaded());
  Stream stream("often_reset");
  ASSERT_TRUE(stream.connected());
  ros::WallRate rate(50.0);
  constexpr int kImages = 150;
  for (int i = 0; i < kImages; ++i) {
    stream.sendPictures(i, i + 1);
    std_srvs::Trigger reset;
    ASSERT_TRUE(ros::service::call("/often_reset/reset", reset));
    EXPECT_TRUE(reset.response.success);
    ros::spinOnce();
    rate.sleep();
  }
  ASSERT_TRUE(stream.receives(kImages)) << stream.lines.size();
  expectContiguousIds(stream.lines);
  EXPECT_GT(stream.lines.back().epoch, stream.lines.front().epoch + kImages / 4);
  EXPECT_TRUE(waitFor([&] { return stream.diagnostics["images tracked"] == std::to_string(kImages); }));
}

TEST(NodeletLife, ASubscriberThatStandsStillCostsTheOthersNothing) {
  ros::param::set("/watched/queue_size", 1000);
  const ManagedNodelet nodelet("watched");
  ASSERT_TRUE(nodelet.isLoaded());
  Stream stream("watched");
  ASSERT_TRUE(stream.connected());
  ros::NodeHandle node;
  bool seen = false;
  const ros::Subscriber news = node.subscribe<sensor_msgs::Image>(
      "/watched/seen", 10, [&](const sensor_msgs::Image::ConstPtr&) { seen = true; });
  const OtherProcess other("watched");
  int sent = 0;
  ASSERT_TRUE(waitFor([&] {
    if (static_cast<int>(stream.lines.size()) == sent) stream.sendPictures(sent, sent + 1), ++sent;
    return seen;
  })) << "the other process sees no picture";
  other.freeze();
  // 90 MB of pictures: more than any buffer on the way holds.
  for (const int end = sent + 400; sent < end; ++sent) {
    stream.sendPictures(sent, sent + 1);
    if (sent % 50 != 0) continue;
    ASSERT_TRUE(stream.receives(static_cast<std::size_t>(sent))) << stream.lines.size();
  }
  ASSERT_TRUE(stream.receives(static_cast<std::size_t>(sent))) << stream.lines.size();
  expectContiguousIds(stream.lines);
  EXPECT_EQ(stream.lines.back().epoch, stream.lines.front().epoch);
}

TEST(NodeletLife, ADriverThatIsKilledAndStartedAgainBeginsAnEpochAfterTheGap) {
  ros::param::set("/driven/queue_size", 1000);
  const ManagedNodelet nodelet("driven");
  ASSERT_TRUE(nodelet.isLoaded());
  std::int64_t epoch = -1;
  for (int life = 0; life < 3; ++life) {
    Stream driver("driven");  // its publishers end with it
    ASSERT_TRUE(driver.connected());
    driver.sendPictures(100 * life, 100 * life + 5);
    ASSERT_TRUE(driver.receives(5)) << life;
    EXPECT_EQ(driver.lines[0].image_count, 1U);
    EXPECT_EQ(driver.lines[4].image_count, 5U);
    EXPECT_EQ(driver.lines[4].epoch, driver.lines[0].epoch);
    EXPECT_EQ(driver.lines[0].epoch, epoch + 1);
    epoch = driver.lines[0].epoch;
  }
}

/// The other process: takes what /NAME publishes and says once that it came.
int subscribe(int argc, char** argv) {
  const std::string name = std::string("/") + argv[2];
  ros::init(argc, argv, "frozen", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher seen = node.advertise<sensor_msgs::Image>(name + "/seen", 1, true);
  const boost::function<void(const LineArray::ConstPtr&)> ignore = [](const LineArray::ConstPtr&) {};
  const ros::Subscriber lines = node.subscribe<LineArray>(name + "/lines", 10, ignore);
  const ros::Subscriber pictures = node.subscribe<sensor_msgs::Image>(
      name + "/debug_image", 10,
      [&](const sensor_msgs::Image::ConstPtr&) { seen.publish(sensor_msgs::Image()); });
  ros::spin();
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "subscribe") == 0) return tet_line_tracker::subscribe(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_life_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
