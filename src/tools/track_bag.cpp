#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "../evaluation/baselines/baseline_tracker.h"
#include "../evaluation/baselines/chord_camera.h"
#include "../ros/image_conversion.h"
#include "../ros/mask_file.h"
#include "../ros/messages.h"
#include "../ros/node_parameters.h"
#include "../ros/sensor_extrinsic.h"
#include "bag_calibration.h"
#include "bag_image.h"
#include "bag_reader.h"
#include "bag_sensor.h"
#include "bag_topics.h"
#include "bag_writer.h"
#include "output_file.h"
#include "parameter_arguments.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/tracking/line_tracker.h"
#include "time_table.h"
#include "track_video.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

constexpr char kStatisticsTopic[] = "/line_tracker/statistics";

struct Arguments {
  std::string input, output;
  std::string image_topic, camera_info_topic, imu_topic, odometry_topic;
  std::string video;    ///< file for the painted images; empty: none
  std::string tracker;  ///< tet, tet_chord or a baseline
  bool with_images{false};
  bool times{false};
};

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

/// A warning between two states of the progress bar.
void warn(ProgressBar& progress, const std::string& sentence) {
  progress.endLine();
  std::fprintf(stderr, "warning: %s\n", sentence.c_str());
}

/// What a mask may do that is hardly meant; empty: nothing.
std::string maskWarning(const std::string& path, const cv::Mat& mask) {
  if (mask.empty()) return {};
  if (cv::countNonZero(mask) == 0) return "the mask " + path + " is black everywhere: no line can be tracked";
  const cv::Mat picture = cv::imread(path, cv::IMREAD_COLOR);
  std::vector<cv::Mat> channels;
  cv::split(picture, channels);
  for (std::size_t i = 1; i < channels.size(); ++i) {
    if (cv::norm(channels[0], channels[i], cv::NORM_INF) == 0.0) continue;
    return "the mask " + path + " is coloured: lines are tracked where its gray value is 128 or more";
  }
  return {};
}

/// Images that are not tracked, as the node drops and counts them.
class Drops {
 public:
  Drops(std::string where, ProgressBar& progress) : where_(std::move(where)), progress_(progress) {}

  /// Tells the first one of a kind.
  void add(const ros::Time& stamp, const std::string& kind, const std::string& reason) {
    if (counts_[kind]++ > 0) return;
    std::ostringstream time;
    time << stamp;
    warn(progress_, "image at " + time.str() + " of " + where_ + " is dropped: " + reason);
  }
  void add(const ros::Time& stamp, StreamVerdict verdict) {
    if (verdict == StreamVerdict::kDropZero) {
      add(stamp, "without a stamp", "it has no stamp");
    } else if (verdict == StreamVerdict::kDropDuplicate) {
      add(stamp, "with the stamp of the image before", "its stamp is the one of the image before");
    } else {
      add(stamp, "late", "its stamp is before the last one");
    }
  }
  /// One line with the counts; nothing when no image was dropped.
  void print() const {
    std::size_t total = 0;
    std::string kinds;
    for (const auto& [kind, count] : counts_) {
      total += count;
      kinds += (kinds.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
    }
    if (total > 0) std::printf("%zu images dropped: %s\n", total, kinds.c_str());
  }

 private:
  std::string where_;
  ProgressBar& progress_;
  std::map<std::string, std::size_t> counts_;
};

constexpr char kUnreadable[] = "unreadable";

/// The images of a view in stamp order, like a live stream without delays: a bag keeps the order of arrival.
std::multimap<ros::Time, rosbag::MessageInstance> inStampOrder(rosbag::View& view, ProgressBar& progress,
                                                               Drops& drops) {
  std::multimap<ros::Time, rosbag::MessageInstance> images;
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    progress.advance();
    try {
      if (const auto header = imageHeader(instance)) images.emplace(header->stamp, instance);
    } catch (const ros::serialization::StreamOverrunException&) {
      drops.add(instance.getTime(), kUnreadable, "its message is cut off");
    }
  }
  return images;
}

void trackBag(const Arguments& arguments, const LineTrackerParameters& tracker_parameters,
              const NodeParameters& node_parameters) {
  rosbag::Bag input;
  openForReading(input, arguments.input);
  const std::string image_topic = chooseImageTopic(input, arguments.image_topic);
  const std::string info_topic = chooseCameraInfoTopic(input, arguments.camera_info_topic, image_topic);
  const std::string imu_topic = chooseImuTopic(input, arguments.imu_topic);
  checkDefinition<tf2_msgs::TFMessage>(input, sequence_bag::kTfTopic);
  checkDefinition<tf2_msgs::TFMessage>(input, sequence_bag::kStaticTfTopic);

  rosbag::View view(input, rosbag::TopicQuery(image_topic));
  rosbag::View everything(input);
  // Each image is met three times: for its stamp, to be copied (or not), and to be tracked.
  ProgressBar progress(2 * view.size() + everything.size());
  Drops drops(image_topic + " in " + arguments.input, progress);
  const auto images = inStampOrder(view, progress, drops);

  LineTracker tracker(tracker_parameters);
  const std::string odometry_topic =
      tracker.usesOdometry() ? chooseOdometryTopic(input, arguments.odometry_topic) : "";
  const bool chords = arguments.tracker == "tet_chord";
  if (arguments.tracker == "tet" || chords) {
    for (const std::string& note : tracker.notes()) std::cerr << "track_bag: " << note << '\n';
  }
  std::unique_ptr<LineFrontEnd> baseline;
  if (arguments.tracker != "tet" && !chords) {
    baseline = makeBaselineTracker(arguments.tracker, tracker_parameters);
    cv::setNumThreads(1);  // times are those of one thread
  }
  LineFrontEnd& front_end = baseline ? *baseline : tracker;

  BagCalibration calibration(input, info_topic);
  const cv::Mat mask = readMask(node_parameters.mask);
  tracker.setMask(mask);
  const std::string mask_warning = maskWarning(node_parameters.mask, mask);
  if (!mask_warning.empty()) warn(progress, mask_warning);
  std::unique_ptr<BagSensor<sensor_msgs::Imu>> imu;
  std::unique_ptr<BagSensor<nav_msgs::Odometry>> odometry;
  const std::string camera_frame = images.empty() ? "" : imageHeader(images.begin()->second)->frame_id;
  if (!imu_topic.empty() && !baseline && tracker.usesImu()) {
    progress.endLine();
    imu = std::make_unique<BagSensor<sensor_msgs::Imu>>(input, imu_topic);
    const auto pose = imu->findPose(camera_frame, imuRotation(node_parameters.imu_rotation), "imu_rotation");
    if (pose) tracker.setImuRotation(pose->linear());
  }
  if (!baseline && tracker.usesOdometry()) {
    progress.endLine();
    odometry = std::make_unique<BagSensor<nav_msgs::Odometry>>(input, odometry_topic);
    const auto pose = odometry->findPose(camera_frame, odometryExtrinsic(node_parameters.odometry_extrinsic),
                                         "odometry_extrinsic");
    if (pose) tracker.setOdometryExtrinsic(*pose);
  }

  BagWriter output(arguments.output);
  // The truth and the calibration travel along, so that one bag is enough to judge the tracks.
  for (const rosbag::MessageInstance& instance : everything) {
    throwIfInterrupted();
    progress.advance();
    if (arguments.with_images || instance.getTopic() != image_topic) output.copy(instance);
  }

  std::unique_ptr<TrackVideo> video;
  if (!arguments.video.empty()) {
    std::vector<ros::Time> stamps;
    for (const auto& image : images) stamps.push_back(image.first);
    video = std::make_unique<TrackVideo>(arguments.video, imageRate(stamps));
  }
  TimeTable times;
  std::shared_ptr<const CameraModel> camera_before;
  std::uint32_t sequence = 0;
  std::size_t lines = 0;
  std::size_t tracks = 0;
  std::size_t cut = 0;
  std::size_t left_out = 0;
  for (const auto& [stamp, instance] : images) {
    throwIfInterrupted();
    progress.advance();
    sensor_msgs::ImageConstPtr image;
    cv::Mat gray;
    try {
      image = readImage(instance);
      gray = toGray(*image, node_parameters.mono16_scale);
    } catch (const std::invalid_argument& error) {
      drops.add(stamp, kUnreadable, error.what());
      continue;
    }
    const std::string complaint = maskComplaint(mask, gray.cols, gray.rows);
    if (!complaint.empty()) throw std::runtime_error(complaint);
    const auto camera = calibration.modelFor(stamp, gray.cols, gray.rows);
    if (camera != camera_before) front_end.setCamera(chords ? asChordCamera(camera) : camera);
    if (video && !chords) video->setCamera(camera);
    camera_before = camera;
    const std::string trouble = calibration.takeComplaint();
    if (!trouble.empty()) warn(progress, trouble);
    const auto stamp_ns = static_cast<std::int64_t>(stamp.toNSec());
    if (imu) imu->feed(tracker.imuStamp(stamp_ns), tracker);
    if (odometry) odometry->feed(stamp_ns, tracker);
    FrameResult result;
    const std::clock_t begin = std::clock();
    try {
      result = front_end.process(gray, stamp_ns);
    } catch (const std::exception& error) {
      drops.add(stamp, kUnreadable, error.what());
      continue;
    }
    const std::clock_t end = std::clock();
    if (isDropped(result.verdict)) drops.add(stamp, result.verdict);
    const LineFrame* frame = result.frame;
    if (frame == nullptr) continue;
    output.write(sequence_bag::kLinesTopic, stamp, toLineArray(*frame, image->header.frame_id, sequence));
    output.write(kStatisticsTopic, stamp, statisticsOf(*frame, image->header.frame_id, sequence, arguments));
    if (video) video->add(gray, *frame);
    ++sequence;
    lines += frame->lines.size();
    tracks += frame->statistics.lines_added;
    cut += frame->statistics.lines_cut;
    left_out += frame->statistics.lines_left_out;
    times.add(frame->statistics);
    // Of all threads: unlike the wall time above, other programs count as little as can be.
    times.add("processor", 1e3 * static_cast<double>(end - begin) / CLOCKS_PER_SEC);
  }
  progress.endLine();
  if (sequence == 0) {
    throw std::runtime_error(arguments.input + " has no image with a stamp that can be read on " +
                             image_topic);
  }
  if (video) video->close();
  output.close();
  std::printf("%u images, %.1f lines per image, %zu tracks of %.1f images on average\n", sequence,
              static_cast<double>(lines) / sequence, tracks,
              tracks == 0 ? 0.0 : static_cast<double>(lines) / static_cast<double>(tracks));
  drops.print();
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
      ("odometry", po::value(&arguments.odometry_topic), "odometry topic for prior=odometry; the only one is taken without asking")
      ("tracker", po::value(&arguments.tracker)->default_value("tet"),
       "tet, or one to compare with: tet_chord (lines straight in the raw image), lsd_lbd_knn, ed_lbd_knn and fld_lbd_knn "
       "(the same with EdgeDrawing and FLD), lsd_remapped (lsd_lbd_knn on undistorted images), lk_endpoints (in their statistics, flow is the matching and refine the description)")
      ("set", po::value(&settings)->composing(), "name=value: one parameter; may be given again")
      ("threads", po::value(&threads), "as --set threads=N; the lines do not depend on it")
      ("times", po::bool_switch(&arguments.times), "write the times of each image to /line_tracker/statistics as well")
      ("video", po::value(&arguments.video), "also write the images with their lines to this file, .mp4 or .avi")
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
  checkOutput(arguments.output, {arguments.input, config, node_parameters.mask});
  if (!arguments.odometry_topic.empty() && tracker_parameters.motion.prior != "odometry") {
    throw std::runtime_error("--odometry needs --set prior=odometry, prior is " +
                             tracker_parameters.motion.prior);
  }
  if (!arguments.video.empty()) {
    checkVideoName(arguments.video);
    checkOutput(arguments.video, {arguments.input, config, node_parameters.mask});
  }
  try {
    trackBag(arguments, tracker_parameters, node_parameters);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("cannot read " + arguments.input + ": " + error.what());
  } catch (const ros::serialization::StreamOverrunException&) {
    throw std::runtime_error("cannot read " + arguments.input + ": a message in it is cut off");
  }
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("track_bag", [&] { return tet_line_tracker::run(argc, argv); });
}
