/// Cameras at a given rate before trackers, in this process or over TCP in that of a nodelet manager; prints
/// a row of the table of scripts/load_test.sh.

#include <nodelet/loader.h>
#include <ros/ros.h>
#include <unistd.h>
#include <visualization_msgs/MarkerArray.h>
#include <boost/make_shared.hpp>
#include <boost/program_options.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "../ros/managed_nodelet.h"
#include "../ros/synthetic_scene.h"
#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string label;
  int cameras{1};
  double rate_hz{60.0};
  double seconds{10.0};
  double flood_s{0.0};  ///< before that, ten times the rate for so long
  int width{752};
  int height{480};
  bool watch{false};     ///< somebody looks at the debug image and at the markers
  bool launched{false};  ///< trackers are loaded by multi_camera.launch
  int manager_pid{0};    ///< of /manager; 0: trackers in this process
};

/// Processor time of a process [s].
double processorTime(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string ignored;
  for (int i = 0; i < 11; ++i) fields >> ignored;
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double residentMegabytes(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

/// A camera that sees rectangles drift to and fro, and the lines that come back.
class Camera {
 public:
  Camera(const std::string& name, const Arguments& arguments) {
    for (int i = 0; i < kPictures; ++i) {
      pictures_.push_back(synthetic_scene::picture(i, arguments.width, arguments.height));
    }
    ros::NodeHandle node;
    const std::string tracker = "/" + name + (arguments.launched ? "/line_tracker" : "");
    images_ = node.advertise<sensor_msgs::Image>("/" + name + "/image", 10);
    lines_ = node.subscribe<LineArray>(
        tracker + "/lines", 1000, [this](const LineArray::ConstPtr& lines) { take(*lines); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    info_ = node.advertise<sensor_msgs::CameraInfo>("/" + name + "/camera_info", 1, true);
    sensor_msgs::CameraInfo info = synthetic_scene::cameraInfo(ros::Time(1));
    info.width = static_cast<std::uint32_t>(arguments.width);
    info.height = static_cast<std::uint32_t>(arguments.height);
    info.K = {0.6 * arguments.width,
              0,
              arguments.width / 2.0,
              0,
              0.6 * arguments.width,
              arguments.height / 2.0,
              0,
              0,
              1};
    info_.publish(info);
    if (!arguments.watch) return;
    debug_images_ = node.subscribe<sensor_msgs::Image>(
        tracker + "/debug_image", 1, [this](const sensor_msgs::Image::ConstPtr&) { ++pictures_seen_; });
    markers_ = node.subscribe(tracker + "/markers", 1, &Camera::ignore);
  }
  bool isConnected() const {
    return images_.getNumSubscribers() == 1 && lines_.getNumPublishers() == 1 &&
           (!debug_images_ || (debug_images_.getNumPublishers() == 1 && markers_.getNumPublishers() == 1));
  }
  /// Debug images since the last call.
  int takePicturesSeen() { return pictures_seen_.exchange(0); }

  void send(int image, const ros::Time& stamp) {
    const int turn = image % (2 * kPictures - 2);
    const int index = turn < kPictures ? turn : 2 * kPictures - 2 - turn;
    const auto message = boost::make_shared<sensor_msgs::Image>(
        synthetic_scene::messageOf(pictures_[static_cast<std::size_t>(index)], "mono8", stamp));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      sent_[stamp] = Clock::now();
    }
    images_.publish(message);
  }
  /// Latencies since the last call [ms]; the number of images without lines is added to `lost`.
  std::vector<double> takeLatencies(std::size_t& lost) {
    const std::lock_guard<std::mutex> lock(mutex_);
    lost += sent_.size();
    sent_.clear();
    return std::exchange(latencies_ms_, {});
  }

 private:
  static constexpr int kPictures = 100;

  static void ignore(const visualization_msgs::MarkerArray::ConstPtr& /*markers*/) {}

  void take(const LineArray& lines) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto sent = sent_.find(lines.header.stamp);
    if (sent == sent_.end()) return;
    latencies_ms_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - sent->second).count());
    sent_.erase(sent);
  }

  std::vector<cv::Mat> pictures_;
  std::mutex mutex_;                             ///< guards the two below
  std::map<ros::Time, Clock::time_point> sent_;  ///< whose lines have not come
  std::vector<double> latencies_ms_;
  std::atomic<int> pictures_seen_{0};
  ros::Publisher images_, info_;
  ros::Subscriber lines_, debug_images_, markers_;
};

/// The trackers, one for each camera.
class Trackers {
 public:
  Trackers(const std::vector<std::string>& names, bool here, bool launched)
      : loader_(here ? new nodelet::Loader(launched) : nullptr) {
    if (launched) return;
    for (const std::string& name : names) {
      if (!here) {
        managed_.push_back(std::make_unique<ManagedNodelet>(name));
        if (!managed_.back()->isLoaded()) throw std::runtime_error("the manager does not load " + name);
        continue;
      }
      const nodelet::M_string remappings{{"/image", "/" + name + "/image"},
                                         {"/camera_info", "/" + name + "/camera_info"},
                                         {"/imu", "/" + name + "/imu"}};
      if (!loader_->load("/" + name, "tet_line_tracker/LineTracker", remappings, {})) {
        throw std::runtime_error("cannot load " + name);
      }
    }
  }

 private:
  std::unique_ptr<nodelet::Loader> loader_;
  std::vector<std::unique_ptr<ManagedNodelet>> managed_;
};

void send(std::vector<std::unique_ptr<Camera>>& cameras, double rate_hz, double seconds, int& image) {
  // Stamps of a real camera; when the machine cannot follow, all are as late as it is.
  const Clock::time_point start = Clock::now();
  const int images = static_cast<int>(rate_hz * seconds);
  for (int i = 0; i < images; ++i, ++image) {
    std::this_thread::sleep_until(start + std::chrono::duration<double>(i / rate_hz));
    for (const auto& camera : cameras) camera->send(image, ros::Time::now());
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0.0
                        : sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

int run(const Arguments& arguments) {
  const bool here = arguments.manager_pid == 0;
  const int pid = here ? getpid() : arguments.manager_pid;
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(arguments.cameras));
  // Parameters of what was launched stay on the server below its name, where other trackers must not find
  // them.
  const std::string stem = arguments.launched ? "launched" : "load";
  for (int i = 0; i < arguments.cameras; ++i) names.push_back(stem + std::to_string(i));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const Trackers trackers(names, here, arguments.launched);
  std::vector<std::unique_ptr<Camera>> cameras;
  cameras.reserve(names.size());
  for (const std::string& name : names) cameras.push_back(std::make_unique<Camera>(name, arguments));
  for (int tries = 0;
       !std::all_of(cameras.begin(), cameras.end(), [](const auto& c) { return c->isConnected(); });) {
    if (++tries > 300) throw std::runtime_error("the trackers do not connect");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  int image = 0;
  send(cameras, arguments.rate_hz, 1.0, image);  // the first images take longer
  if (arguments.flood_s > 0.0) send(cameras, 10.0 * arguments.rate_hz, arguments.flood_s, image);
  std::size_t lost = 0;
  for (const auto& camera : cameras) {
    camera->takeLatencies(lost);
    camera->takePicturesSeen();
  }

  lost = 0;
  int pictures = 0;
  const double before = processorTime(pid);
  send(cameras, arguments.rate_hz, arguments.seconds, image);
  const double share = 100.0 * (processorTime(pid) - before) / arguments.seconds;
  std::vector<double> latencies;
  for (const auto& camera : cameras) {
    const std::vector<double> its = camera->takeLatencies(lost);
    latencies.insert(latencies.end(), its.begin(), its.end());
    pictures += camera->takePicturesSeen();
  }
  std::sort(latencies.begin(), latencies.end());
  std::printf("| %s | %s | %zu | %.1f | %.1f | %.1f | %.0f | %.0f | %zu | %s |\n", arguments.label.c_str(),
              here ? "one process" : "TCP", latencies.size() + lost, quantile(latencies, 0.5),
              quantile(latencies, 0.99), quantile(latencies, 1.0), share, residentMegabytes(pid), lost,
              arguments.watch ? std::to_string(pictures).c_str() : "-");
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  using namespace tet_line_tracker;
  Arguments arguments;
  po::options_description options;
  options.add_options()("label", po::value(&arguments.label))("cameras", po::value(&arguments.cameras))(
      "rate", po::value(&arguments.rate_hz))("seconds", po::value(&arguments.seconds))(
      "flood", po::value(&arguments.flood_s))("width", po::value(&arguments.width))(
      "height", po::value(&arguments.height))("watch", po::bool_switch(&arguments.watch))(
      "launched", po::bool_switch(&arguments.launched))("manager-pid", po::value(&arguments.manager_pid));
  ros::init(argc, argv, "load_generator");
  try {
    po::variables_map values;
    po::store(po::parse_command_line(argc, argv, options), values);
    po::notify(values);
    return run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "load_generator: " << error.what() << "\n";
    return 1;
  }
}
