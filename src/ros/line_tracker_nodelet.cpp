#include "line_tracker_nodelet.h"

#include <ros/master.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "image_conversion.h"
#include "mask_file.h"
#include "messages.h"

namespace tet_line_tracker {
namespace {

/// Images that wait for the callback, which only hands them on to the worker. Large, because what is lost
/// here is not counted: the short queue is the worker's.
constexpr std::uint32_t kTransportQueue = 1000;
constexpr std::uint32_t kCameraInfoQueue = 10;
constexpr std::uint32_t kImuQueue = 2000;
/// Lines matter to estimators, so a slow subscriber gets this many messages of slack.
constexpr std::uint32_t kLinesQueue = 100;
constexpr std::uint32_t kDisplayQueue = 2;
/// Times after which the same thing is told again [s].
constexpr double kDropPeriod = 10.0;
constexpr double kSilencePeriod = 60.0;
/// Images after which an IMU whose frame does not lead to the camera's is told. Until then they wait for the
/// frames as they wait for the IMU's messages.
constexpr int kFramesPatience = 20;

double stampSeconds(std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns) * 1e-9;
}

/// Throws std::invalid_argument when the transport that the private parameter image_transport asks for is not
/// there: image_transport itself would find out only after the outputs are advertised.
void checkTransport(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  std::string transport = "raw";
  private_node.getParam("image_transport", transport);
  std::string known;
  for (const std::string& name : image_transport::ImageTransport(node).getLoadableTransports()) {
    const std::string short_name = name.substr(name.find('/') + 1);
    if (short_name == transport) return;
    known += (known.empty() ? "" : ", ") + short_name;
  }
  throw std::invalid_argument("parameter image_transport is " + transport +
                              ", needs one that is installed: " + known);
}

/// Topics that carry images but for `own`, for a user who named another.
std::string imageTopics(const std::string& own) {
  ros::master::V_TopicInfo topics;
  if (!ros::master::getTopics(topics)) return "unknown, the master does not answer";
  std::vector<std::string> names;
  for (const ros::master::TopicInfo& topic : topics) {
    if (topic.name == own) continue;
    if (topic.datatype == "sensor_msgs/Image" || topic.datatype == "sensor_msgs/CompressedImage") {
      names.push_back(topic.name);
    }
  }
  std::sort(names.begin(), names.end());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

}  // namespace

LineTrackerNodelet::~LineTrackerNodelet() {
  if (queue_) queue_->close();
  if (worker_.joinable()) worker_.join();
}

void LineTrackerNodelet::onInit() {
  try {
    loadParameters();
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
#ifndef __OPTIMIZE__
  NODELET_WARN("built without optimisation: expect a tenth of the speed; use CMAKE_BUILD_TYPE=Release");
#endif
  advertise();
  worker_ = std::thread(&LineTrackerNodelet::work, this);
  subscribe();
}

void LineTrackerNodelet::loadParameters() {
  tet_line_tracker::loadParameters(getPrivateNodeHandle(), tracker_parameters_, parameters_);
  checkTransport(getNodeHandle(), getPrivateNodeHandle());
  tracker_ = std::make_unique<LineTracker>(tracker_parameters_);
  mask_ = readMask(parameters_.mask);
  tracker_->setMask(mask_);
  imu_rotation_ = imuRotation(parameters_.imu_rotation);
  if (imu_rotation_) tracker_->setImuRotation(*imu_rotation_);
  imu_rotation_known_ = imu_rotation_.has_value();
  queue_ = std::make_unique<NewestQueue<sensor_msgs::ImageConstPtr>>(parameters_.queue_size);
  throttle_ = std::make_unique<PublishThrottle>(parameters_.publish_rate);
  markers_ = std::make_unique<MarkerBuilder>(parameters_.marker_ids);
}

void LineTrackerNodelet::advertise() {
  ros::NodeHandle& node = getPrivateNodeHandle();
  lines_publisher_ = node.advertise<LineArray>("lines", kLinesQueue);
  markers_publisher_ = node.advertise<visualization_msgs::MarkerArray>("markers", kDisplayQueue);
  statistics_publisher_ = node.advertise<TrackingStatistics>("statistics", kLinesQueue);
  debug_image_publisher_ = image_transport::ImageTransport(node).advertise("debug_image", kDisplayQueue);
  updater_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), node, getName());
  updater_->setHardwareID("none");
  updater_->add("line tracking", this, &LineTrackerNodelet::reportDiagnostics);
}

void LineTrackerNodelet::subscribe() {
  ros::NodeHandle& node = getNodeHandle();
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  reset_server_ = private_node.advertiseService("reset", &LineTrackerNodelet::onReset, this);
  camera_info_subscriber_ =
      node.subscribe("camera_info", kCameraInfoQueue, &LineTrackerNodelet::onCameraInfo, this);
  // Also when no parameter asks for the IMU: players of bags wait until every topic is taken.
  frames_listener_ = std::make_unique<tf2_ros::TransformListener>(frames_, node);
  imu_subscriber_ =
      node.subscribe("imu", kImuQueue, &LineTrackerNodelet::onImu, this, ros::TransportHints().tcpNoDelay());
  const image_transport::TransportHints hints("raw", ros::TransportHints().tcpNoDelay(), private_node);
  image_subscriber_ = image_transport::ImageTransport(node).subscribe(
      "image", kTransportQueue, &LineTrackerNodelet::onImage, this, hints);
  // The wall clock: simulated time stands still exactly when there is something to tell.
  timer_ = node.createWallTimer(ros::WallDuration(1.0), &LineTrackerNodelet::onTimer, this);
  NODELET_INFO("tracks lines of %s (%s), method %s, detector %s", image_subscriber_.getTopic().c_str(),
               image_subscriber_.getTransport().c_str(), tracker_parameters_.method.c_str(),
               tracker_->detectorName().c_str());
  for (const std::string& note : tracker_->notes()) NODELET_WARN("%s", note.c_str());
}

void LineTrackerNodelet::onImage(const sensor_msgs::ImageConstPtr& image) {
  diagnostics_.addReceived();
  queue_->push(image);
}

void LineTrackerNodelet::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& info) {
  if (const auto complaint = calibration_.update(*info)) {
    NODELET_WARN("%s: %s", camera_info_subscriber_.getTopic().c_str(), complaint->c_str());
  }
}

void LineTrackerNodelet::onImu(const sensor_msgs::ImuConstPtr& message) {
  if (tracker_->usesImu()) imu_.add(*message);
}

bool LineTrackerNodelet::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(tracker_mutex_);
  const std::size_t dropped = tracker_->reset();
  response.success = 1U;
  response.message = std::to_string(dropped) + " tracks dropped, the next image starts a new epoch";
  NODELET_INFO("reset: %s", response.message.c_str());
  return true;
}

void LineTrackerNodelet::onTimer(const ros::WallTimerEvent&) {
  diagnostics_.setDroppedInQueue(queue_->replaced());
  updater_->force_update();
  warnOfSilence();
}

void LineTrackerNodelet::warnOfSilence() {
  const double silence = diagnostics_.secondsWithoutImage();
  if (silence < StreamDiagnostics::kSilence) {
    silence_told_ = ros::WallTime();
    return;
  }
  const ros::WallTime now = ros::WallTime::now();
  if (!silence_told_.isZero() && now - silence_told_ < ros::WallDuration(kSilencePeriod)) return;
  silence_told_ = now;
  NODELET_WARN("no image for %.0f s on %s (publishers: %u); topics with images: %s", silence,
               image_subscriber_.getTopic().c_str(), image_subscriber_.getNumPublishers(),
               imageTopics(debug_image_publisher_.getTopic()).c_str());
}

void LineTrackerNodelet::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  StreamDiagnostics::Setup setup;
  setup.image_topic = image_subscriber_.getTopic();
  setup.detector = tracker_->detectorName();
  setup.calibration = calibration_.state();
  setup.calibrated = calibrated_;
  setup.imu = imuState();
  diagnostics_.report(setup, status);
}

std::string LineTrackerNodelet::imuState() const {
  std::string topic = imu_subscriber_.getTopic();
  if (!tracker_->usesImu()) return "not asked for";
  const std::optional<std::string> frame = imu_.frame();
  if (!frame) return "no message on " + topic;
  if (!imu_rotation_known_) return topic + ", no transform from its frame " + *frame + " to the camera's";
  return topic;
}

void LineTrackerNodelet::work() {
  while (const auto image = queue_->pop()) {
    try {
      track(*image);
    } catch (const std::exception& error) {
      drop(DropReason::kUnreadable, error.what());
    }
  }
}

void LineTrackerNodelet::track(const sensor_msgs::ImageConstPtr& image) {
  const std::uint64_t replaced_before = queue_->replaced();
  const cv::Mat gray = toGray(*image, parameters_.mono16_scale);
  const auto stamp_ns = static_cast<std::int64_t>(image->header.stamp.toNSec());
  const CalibrationInput::Model model = calibration_.modelFor(gray.cols, gray.rows);
  if (model.complaint) {
    NODELET_WARN("%s: %s", camera_info_subscriber_.getTopic().c_str(), model.complaint->c_str());
  }
  calibrated_ = model.camera != nullptr;
  checkMask(gray.cols, gray.rows);
  if (tracker_->usesImu()) awaitImu(image->header);

  const std::lock_guard<std::mutex> lock(tracker_mutex_);
  tracker_->setCamera(model.camera);
  if (imu_rotation_) imu_.feed(stamp_ns, *tracker_);
  const FrameResult result = tracker_->process(gray, stamp_ns);
  if (isDropped(result.verdict)) {
    dropByStamp(result.verdict);
    return;
  }
  const LineFrame* frame = result.frame;
  if (epoch_ != frame->epoch) {
    if (epoch_) NODELET_INFO("epoch %u begins at stamp %.6f", frame->epoch, stampSeconds(stamp_ns));
    epoch_ = frame->epoch;
    replaced_before_epoch_ = replaced_before;
    throttle_->reset();
  }
  diagnostics_.addTracked(*frame, frame->statistics.total_ms);
  if (throttle_->pass(stamp_ns)) publish(*frame, gray, *image);
}

/// Without tracker_mutex_, so that a reset need not wait with the image.
void LineTrackerNodelet::awaitImu(const std_msgs::Header& image) {
  const auto stamp_ns = static_cast<std::int64_t>(image.stamp.toNSec());
  if (!imu_.frame() && imu_subscriber_.getNumPublishers() == 0) return;
  const bool patient = imu_rotation_ || images_without_rotation_ < kFramesPatience;
  const bool there = imu_.waitFor(stamp_ns, patient ? parameters_.imu_wait : 0.0);
  if (!imu_rotation_ && imu_.frame()) findImuRotation(image.frame_id);
  if (!there && imu_rotation_) diagnostics_.addWithoutImu();
}

void LineTrackerNodelet::findImuRotation(const std::string& camera_frame) {
  const std::string imu_frame = *imu_.frame();
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(parameters_.imu_wait);
  imu_rotation_ = imuRotation(frames_, imu_frame, camera_frame);
  while (!imu_rotation_ && images_without_rotation_ < kFramesPatience && ros::WallTime::now() < end) {
    ros::WallDuration(0.005).sleep();
    imu_rotation_ = imuRotation(frames_, imu_frame, camera_frame);
  }
  if (imu_rotation_) {
    const std::lock_guard<std::mutex> lock(tracker_mutex_);
    tracker_->setImuRotation(*imu_rotation_);
    imu_rotation_known_ = true;
    return;
  }
  if (images_without_rotation_ > kFramesPatience) return;
  if (images_without_rotation_++ < kFramesPatience) return;
  NODELET_WARN(
      "%s is not used: after %d images no transform leads from its frame '%s' to the camera's '%s', "
      "and imu_rotation is empty",
      imu_subscriber_.getTopic().c_str(), kFramesPatience, imu_frame.c_str(), camera_frame.c_str());
}

void LineTrackerNodelet::checkMask(int width, int height) {
  const std::string complaint = maskComplaint(mask_, width, height);
  if (complaint.empty() || mask_told_ == cv::Size(width, height)) return;
  mask_told_ = cv::Size(width, height);
  NODELET_ERROR("%s: %s; lines are tracked in the whole image", parameters_.mask.c_str(), complaint.c_str());
}

void LineTrackerNodelet::publish(const LineFrame& frame, const cv::Mat& gray,
                                 const sensor_msgs::Image& image) {
  const std::string& frame_id = image.header.frame_id;
  lines_publisher_.publish(
      boost::make_shared<const LineArray>(toLineArray(frame, frame_id, lines_sequence_++)));
  diagnostics_.addPublished();

  if (statistics_publisher_.getNumSubscribers() > 0) {
    const auto replaced = static_cast<std::uint32_t>(queue_->replaced() - replaced_before_epoch_);
    statistics_publisher_.publish(boost::make_shared<const TrackingStatistics>(
        toTrackingStatistics(frame, frame_id, statistics_sequence_++, replaced)));
  }
  if (markers_publisher_.getNumSubscribers() > 0) {
    markers_publisher_.publish(
        boost::make_shared<const visualization_msgs::MarkerArray>(markers_->build(frame, frame_id)));
  }
  if (debug_image_publisher_.getNumSubscribers() > 0) {
    const auto picture = boost::make_shared<sensor_msgs::Image>();
    picture->header = image.header;
    picture->encoding = sensor_msgs::image_encodings::BGR8;
    picture->width = image.width;
    picture->height = image.height;
    picture->step = 3 * image.width;
    picture->data.resize(static_cast<std::size_t>(picture->step) * picture->height);
    cv::Mat bgr(gray.rows, gray.cols, CV_8UC3, picture->data.data(), picture->step);
    painter_.paint(gray, frame, bgr);
    debug_image_publisher_.publish(sensor_msgs::ImageConstPtr(picture));
  }
}

void LineTrackerNodelet::dropByStamp(StreamVerdict verdict) {
  if (verdict == StreamVerdict::kDropZero) {
    drop(DropReason::kZero, "it has no stamp");
  } else if (verdict == StreamVerdict::kDropDuplicate) {
    drop(DropReason::kDuplicate, "its stamp is the one of the image before");
  } else {
    drop(DropReason::kLate, "its stamp is before the last one");
  }
}

/// Not ROS_WARN_THROTTLE, which counts simulated time and tells nothing before the first clock message.
void LineTrackerNodelet::drop(DropReason reason, const std::string& sentence) {
  const std::uint64_t count = diagnostics_.addDropped(reason);
  ros::WallTime& told = drop_told_[static_cast<std::size_t>(reason)];
  const ros::WallTime now = ros::WallTime::now();
  if (!told.isZero() && now - told < ros::WallDuration(kDropPeriod)) return;
  told = now;
  NODELET_ERROR("image of %s dropped (%llu so far): %s", image_subscriber_.getTopic().c_str(),
                static_cast<unsigned long long>(count), sentence.c_str());
}

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::LineTrackerNodelet, nodelet::Nodelet)
