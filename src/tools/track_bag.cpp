#include <cstdio>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <boost/program_options.hpp>

#include "../evaluation/baselines/baseline_tracker.h"
#include "../ros/camera_info.h"
#include "../ros/image_conversion.h"
#include "../ros/imu_extrinsic.h"
#include "../ros/mask_file.h"
#include "../ros/messages.h"
#include "../ros/node_parameters.h"
#include "bag_imu.h"
#include "bag_writer.h"
#include "parameter_arguments.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/tracking/line_tracker.h"
#include "time_table.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

constexpr char kStatisticsTopic[] = "/line_tracker/statistics";

struct Arguments {
  std::string input, output;
  std::string image_topic, camera_info_topic, imu_topic;
  std::string tracker;  ///< tet or a baseline
  bool with_images{false};
  bool times{false};
};

/// The topic that was asked for, or the only one of its type in the bag.
std::string chooseTopic(const std::string& asked, const std::string& type, const rosbag::Bag& bag,
                        const std::string& path, bool required) {
  std::set<std::string> topics;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (connection->datatype == type) topics.insert(connection->topic);
  }
  topics.erase(sequence_bag::kDepthTopic);
  std::string list;
  for (const std::string& topic : topics) list += (list.empty() ? "" : ", ") + topic;
  if (list.empty()) list = "none";
  if (!asked.empty()) {
    if (topics.count(asked) == 0) {
      throw std::runtime_error(path + " has no topic " + asked + " of type " + type + "; it has: " + list);
    }
    return asked;
  }
  if (topics.size() == 1) return *topics.begin();
  if (!required && topics.empty()) return {};
  throw std::runtime_error(path + " has " + std::to_string(topics.size()) + " topics of type " + type + " (" +
                           list + "), name one");
}

/// The IMU that was asked for, or the only one of the bag; none when there is more than one.
std::string chooseImu(const Arguments& arguments, const rosbag::Bag& bag) {
  if (arguments.imu_topic.empty()) {
    rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<sensor_msgs::Imu>()));
    std::set<std::string> topics;
    for (const rosbag::ConnectionInfo* connection : view.getConnections()) topics.insert(connection->topic);
    return topics.size() == 1 ? *topics.begin() : std::string();
  }
  return chooseTopic(arguments.imu_topic, "sensor_msgs/Imu", bag, arguments.input, true);
}

/// Without --times they are not a number: the same images then give the same bytes.
TrackingStatistics statisticsOf(const LineFrame& frame, const std::string& frame_id, std::uint32_t sequence,
                                const Arguments& arguments) {
  TrackingStatistics message = toTrackingStatistics(frame, frame_id, sequence, 0);
  if (!arguments.times) {
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    message.pyramid_ms = message.prior_ms = message.flow_ms = message.refine_ms = unknown;
    message.detect_ms = message.undistort_ms = message.total_ms = unknown;
  }
  return message;
}

void trackBag(const Arguments& arguments, const LineTrackerParameters& tracker_parameters,
              const NodeParameters& node_parameters) {
  rosbag::Bag input;
  try {
    input.open(arguments.input, rosbag::bagmode::Read);
  } catch (const std::exception& error) {
    throw std::runtime_error("cannot read " + arguments.input + ": " + error.what());
  }
  const std::string image_topic =
      chooseTopic(arguments.image_topic, "sensor_msgs/Image", input, arguments.input, true);
  const std::string info_topic =
      chooseTopic(arguments.camera_info_topic, "sensor_msgs/CameraInfo", input, arguments.input, false);

  const std::string imu_topic = chooseImu(arguments, input);

  // In stamp order, like a live stream without delays: a bag keeps the order of arrival.
  rosbag::View view(input, rosbag::TopicQuery(image_topic));
  std::multimap<ros::Time, rosbag::MessageInstance> images;
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto image = instance.instantiate<sensor_msgs::Image>())
      images.emplace(image->header.stamp, instance);
  }

  LineTracker tracker(tracker_parameters);
  std::unique_ptr<LineFrontEnd> baseline;
  if (arguments.tracker != "tet") {
    baseline = makeBaselineTracker(arguments.tracker, tracker_parameters);
    cv::setNumThreads(1);  // times are those of one thread
  }
  if (!info_topic.empty()) {
    rosbag::View info_view(input, rosbag::TopicQuery(info_topic));
    const auto info = info_view.begin()->instantiate<sensor_msgs::CameraInfo>();
    const auto camera = makeCameraModel(fromCameraInfo(*info));
    tracker.setCamera(camera);
    if (baseline) baseline->setCamera(camera);
  }

  const cv::Mat mask = readMask(node_parameters.mask);
  tracker.setMask(mask);
  std::unique_ptr<BagImu> imu;
  if (!imu_topic.empty() && !baseline && tracker.usesImu() && !images.empty()) {
    imu = std::make_unique<BagImu>(input, imu_topic);
    const auto image = images.begin()->second.instantiate<sensor_msgs::Image>();
    imu->setRotation(image->header.frame_id, imuRotation(node_parameters.imu_rotation), tracker);
  }

  BagWriter output(arguments.output);
  // The truth and the calibration travel along, so that one bag is enough to judge the tracks.
  rosbag::View everything(input);
  for (const rosbag::MessageInstance& instance : everything) {
    if (arguments.with_images || instance.getTopic() != image_topic) {
      output.write(instance.getTopic(), instance.getTime(), instance);
    }
  }

  TimeTable times;
  std::uint32_t sequence = 0;
  std::size_t lines = 0;
  std::size_t tracks = 0;
  std::size_t cut = 0;
  std::size_t left_out = 0;
  ProgressBar progress(images.size());
  for (const auto& [stamp, instance] : images) {
    throwIfInterrupted();
    progress.advance();
    const auto image = instance.instantiate<sensor_msgs::Image>();
    const cv::Mat gray = toGray(*image, node_parameters.mono16_scale);
    const std::string complaint = maskComplaint(mask, gray.cols, gray.rows);
    if (!complaint.empty()) throw std::runtime_error(complaint);
    const auto stamp_ns = static_cast<std::int64_t>(stamp.toNSec());
    if (imu) imu->feed(stamp_ns, tracker);
    LineFrontEnd& front_end = baseline ? *baseline : tracker;
    const LineFrame* frame = front_end.process(gray, stamp_ns).frame;
    if (frame == nullptr) continue;
    output.write(sequence_bag::kLinesTopic, stamp, toLineArray(*frame, image->header.frame_id, sequence));
    output.write(kStatisticsTopic, stamp, statisticsOf(*frame, image->header.frame_id, sequence, arguments));
    ++sequence;
    lines += frame->lines.size();
    tracks += frame->statistics.lines_added;
    cut += frame->statistics.lines_cut;
    left_out += frame->statistics.lines_left_out;
    times.add(frame->statistics);
  }
  if (sequence == 0)
    throw std::runtime_error(arguments.input + " has no image with a stamp on " + image_topic);
  output.close();
  std::printf("%u images, %.1f lines per image, %zu tracks of %.1f images on average\n", sequence,
              static_cast<double>(lines) / sequence, tracks,
              tracks == 0 ? 0.0 : static_cast<double>(lines) / static_cast<double>(tracks));
  if (cut + left_out > 0) std::printf("field of view: %zu lines cut, %zu left out\n", cut, left_out);
  times.print();
}

int run(int argc, char** argv) {
  Arguments arguments;
  std::string config;
  std::string threads;
  std::vector<std::string> settings;
  po::options_description options;
  // clang-format off
  options.add_options()
      ("input", po::value(&arguments.input)->required())
      ("output", po::value(&arguments.output)->required())
      ("config", po::value(&config), "YAML file with parameters, as for the node")
      ("image", po::value(&arguments.image_topic), "image topic; needed when the bag has several")
      ("camera-info", po::value(&arguments.camera_info_topic), "camera_info topic; needed when the bag has several")
      ("imu", po::value(&arguments.imu_topic), "IMU topic for the motion prior; the only one is taken without asking")
      ("tracker", po::value(&arguments.tracker)->default_value("tet"),
       "tet, or a baseline to compare with: lsd_lbd_knn, lk_endpoints (in their statistics, flow is the matching and "
       "refine the description)")
      ("set", po::value(&settings)->composing(), "name=value: one parameter; may be given again")
      ("threads", po::value(&threads), "as --set threads=N; the lines do not depend on it")
      ("times", po::bool_switch(&arguments.times), "write the times of each image to /line_tracker/statistics as well")
      ("with-images", po::bool_switch(&arguments.with_images), "copy the images to the output as well");
  // clang-format on
  po::positional_options_description positional;
  positional.add("input", 1).add("output", 1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "track_bag IN.bag OUT.bag [options]\n\nTracks lines through every image of a bag, in stamp "
          "order, and writes them to /line_tracker/lines.",
          options, positional, values)) {
    return 0;
  }

  if (!threads.empty()) settings.push_back("threads=" + threads);
  LineTrackerParameters tracker_parameters;
  NodeParameters node_parameters;
  ParameterTable table = tableOf(tracker_parameters);
  table.append(tableOf(node_parameters));
  setParameters(config, settings, table);
  std::string broken;
  for (const std::string& sentence : check(tracker_parameters))
    broken += (broken.empty() ? "" : "; ") + sentence;
  for (const std::string& sentence : check(node_parameters)) {
    broken += (broken.empty() ? "" : "; ") + sentence;
  }
  if (!broken.empty()) throw std::runtime_error(broken);
  trackBag(arguments, tracker_parameters, node_parameters);
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("track_bag", [&] { return tet_line_tracker::run(argc, argv); });
}
