/// A tracker whose master dies: brings its own master, so that it may be killed.

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <string>

#include "stream_diagnostics.h"
#include "synthetic_scene.h"
#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {
namespace {

bool waitFor(const std::function<bool()>& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(30.0);
  while (!condition()) {
    if (ros::WallTime::now() > end) return false;
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  return true;
}

/// A rosmaster on a port of its own.
class Master {
 public:
  Master() : port_(freePort()), process_(fork()) {
    if (process_ != 0) return;
    execlp("rosmaster", "rosmaster", "--core", "-p", port_.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  ~Master() { kill(); }
  std::string uri() const { return "http://localhost:" + port_; }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  static std::string freePort() {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    ::bind(socket, reinterpret_cast<sockaddr*>(&address), size);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(socket);
    return std::to_string(ntohs(address.sin_port));
  }

  std::string port_;
  pid_t process_;
};

TEST(MasterLoss, ImagesAfterASilenceAreTrackedWithoutAMaster) {
  Master master;
  ros::init(ros::M_string{{"__master", master.uri()}}, "master_loss_test",
            ros::init_options::NoSigintHandler);
  ASSERT_TRUE(waitFor(ros::master::check));
  ros::NodeHandle node;
  ros::param::set("/tracker/queue_size", 1000);
  {
    nodelet::Loader loader(false);
    ASSERT_TRUE(loader.load("/tracker", "tet_line_tracker/LineTracker", {}, {}));
    std::size_t received = 0;
    const ros::Subscriber lines =
        node.subscribe<LineArray>("/tracker/lines", 100, [&](const LineArray::ConstPtr&) { ++received; });
    ros::Publisher images = node.advertise<sensor_msgs::Image>("/image", 100);
    ASSERT_TRUE(waitFor([&] { return lines.getNumPublishers() == 1 && images.getNumSubscribers() == 1; }));
    int image = 0;
    const auto send = [&](int count) {
      for (const int end = image + count; image < end; ++image) {
        images.publish(synthetic_scene::monoMessage(image, ros::Time(1000.0 + 0.05 * image)));
      }
    };
    send(5);
    ASSERT_TRUE(waitFor([&] { return received == 5; }));

    master.kill();
    // The tracker sees the silence, and would like to know which topics carry images.
    ros::WallDuration(StreamDiagnostics::kSilence + 2.0).sleep();
    send(20);
    EXPECT_TRUE(waitFor([&] { return received == 25; })) << received << " of 25 images were tracked";
    if (HasFailure()) std::_Exit(1);  // a tracker that waits for its master cannot be unloaded
  }
  ros::shutdown();
}

}  // namespace
}  // namespace tet_line_tracker
