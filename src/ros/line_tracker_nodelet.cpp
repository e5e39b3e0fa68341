#include "line_tracker_nodelet.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <pluginlib/class_list_macros.hpp>

#include "encoded_image.h"
#include "image_conversion.h"
#include "mask_file.h"

namespace tet_line_tracker {
namespace {

/// Images that wait for the callback, which only hands them on to the worker. Large, because what is lost
/// here is not counted: the short queue is the worker's.
constexpr std::uint32_t kTransportQueue = 1000;
constexpr std::uint32_t kCameraInfoQueue = 10;
constexpr std::uint32_t kMotionQueue = 2000;

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
  serveParameters();
}

void LineTrackerNodelet::loadParameters() {
  LineTrackerParameters parameters;
  tet_line_tracker::loadParameters(getPrivateNodeHandle(), parameters, parameters_);
  checkImageTransport(getNodeHandle(), getPrivateNodeHandle());
  tracker_ = std::make_unique<LineTracker>(parameters);
  noteTracker();
  mask_ = readMask(parameters_.mask);
  tracker_->setMask(mask_);
  imu_.extrinsic.set(imuRotation(parameters_.imu_rotation));
  odometry_.extrinsic.set(odometryExtrinsic(parameters_.odometry_extrinsic));
  queue_ = std::make_unique<NewestQueue<ImageMessage>>(parameters_.queue_size);
}

void LineTrackerNodelet::advertise() {
  ros::NodeHandle& node = getPrivateNodeHandle();
  publisher_ = std::make_unique<LinePublisher>(node, parameters_);
  silence_warning_ =
      std::make_unique<SilenceWarning>([own = publisher_->debugImageTopic()] { return imageTopics(own); });
  updater_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), node, getName());
  updater_->setHardwareID("none");
  updater_->add("line tracking", this, &LineTrackerNodelet::reportDiagnostics);
}

void LineTrackerNodelet::subscribe() {
  ros::NodeHandle& node = getNodeHandle();
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  // Before any callback, which may come while its subscriber is not assigned yet.
  const std::string image_topic = node.resolveName("image");
  image_topic_ = topicOfTransport(image_topic, hints.getTransport());
  camera_info_topic_ = node.resolveName("camera_info");
  imu_.topic = node.resolveName("imu");
  odometry_.topic = node.resolveName("odometry");
  reset_server_ = private_node.advertiseService("reset", &LineTrackerNodelet::onReset, this);
  camera_info_subscriber_ =
      node.subscribe("camera_info", kCameraInfoQueue, &LineTrackerNodelet::onCameraInfo, this);
  // Also when no parameter asks for them: players of bags wait until every topic is taken.
  tf_listener_ = std::make_unique<tf2_ros::TransformListener>(tf_buffer_, node);
  imu_subscriber_ = node.subscribe("imu", kMotionQueue, &LineTrackerNodelet::onImu, this, no_delay);
  odometry_subscriber_ =
      node.subscribe("odometry", kMotionQueue, &LineTrackerNodelet::onOdometry, this, no_delay);
  image_subscription_ = std::make_unique<ImageSubscription>(
      node, image_topic, kTransportQueue, [this](const ImageMessage& image) { onImage(image); }, hints);
  // The wall clock: simulated time stands still exactly when there is something to warn of.
  timer_ = node.createWallTimer(ros::WallDuration(1.0), &LineTrackerNodelet::onTimer, this);
  NODELET_INFO("tracks lines of %s (%s), method %s, detector %s", image_topic_.c_str(),
               hints.getTransport().c_str(), tracker_->parameters().method.c_str(),
               tracker_->detectorName().c_str());
  for (const std::string& note : tracker_->notes()) NODELET_WARN("%s", note.c_str());
}

void LineTrackerNodelet::serveParameters() {
  ReconfigureServer::Handlers handlers;
  handlers.apply = [this](const auto& tracker, const auto& parameters) {
    applyParameters(tracker, parameters);
  };
  handlers.inform = [this](const std::string& sentence) { NODELET_INFO("%s", sentence.c_str()); };
  handlers.warn = [this](const std::string& sentence) { NODELET_WARN("%s", sentence.c_str()); };
  reconfigure_server_ = std::make_unique<ReconfigureServer>(getPrivateNodeHandle(), tracker_->parameters(),
                                                            parameters_, std::move(handlers));
}

void LineTrackerNodelet::applyParameters(const LineTrackerParameters& tracker,
                                         const NodeParameters& parameters) {
  const std::lock_guard<std::mutex> lock(tracker_mutex_);
  // What may throw comes before what changes.
  const bool other_mask = parameters.mask != parameters_.mask;
  const cv::Mat mask = other_mask ? readMask(parameters.mask) : cv::Mat();
  const std::vector<std::string> notes = tracker_->notes();
  if (tracker_->setParameters(tracker)) NODELET_INFO("the next image starts a new epoch");
  if (other_mask) {
    mask_ = mask;
    tracker_->setMask(mask_);
    mask_warning_.reset();
  }
  parameters_ = parameters;
  publisher_->setParameters(parameters);
  queue_->setCapacity(static_cast<std::size_t>(parameters.queue_size));
  noteTracker();
  for (const std::string& note : tracker_->notes()) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) NODELET_WARN("%s", note.c_str());
  }
}

void LineTrackerNodelet::noteTracker() {
  uses_imu_ = tracker_->usesImu();
  uses_odometry_ = tracker_->usesOdometry();
  diagnostics_.setDetector(tracker_->detectorName());
}

void LineTrackerNodelet::onImage(const ImageMessage& image) {
  diagnostics_.addReceived();
  queue_->push(image);
  imu_.input.wake();
  odometry_.input.wake();
}

void LineTrackerNodelet::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& info) {
  if (const auto warning = calibration_.update(*info)) {
    NODELET_WARN("%s: %s", camera_info_topic_.c_str(), warning->c_str());
  }
}

void LineTrackerNodelet::onImu(const sensor_msgs::ImuConstPtr& message) {
  if (uses_imu_) imu_.input.add(*message);
}

void LineTrackerNodelet::onOdometry(const nav_msgs::OdometryConstPtr& message) {
  if (uses_odometry_) odometry_.input.add(*message);
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
  const double silence = diagnostics_.secondsWithoutImage();
  if (const auto topics = silence_warning_->update(silence >= StreamDiagnostics::kSilence)) {
    NODELET_WARN("no image for %.0f s on %s (publishers: %u); topics with images: %s", silence,
                 image_topic_.c_str(), image_subscription_->publishers(), topics->c_str());
  }
}

void LineTrackerNodelet::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  StreamDiagnostics::Setup setup;
  setup.image_topic = image_topic_;
  setup.calibration = calibration_.state();
  setup.calibrated = calibrated_;
  setup.imu = stateOf(imu_, uses_imu_);
  setup.odometry = stateOf(odometry_, uses_odometry_);
  setup.imu_in_step = !imu_.input.outOfStep();
  setup.odometry_in_step = !odometry_.input.outOfStep();
  if (uses_imu_) setup.imu_lag_s = imu_.input.lag();
  if (uses_odometry_) setup.odometry_lag_s = odometry_.input.lag();
  diagnostics_.report(setup, status);
}

template <class Sample>
std::string LineTrackerNodelet::stateOf(const MotionSensor<Sample>& sensor, bool used) const {
  if (!used) return "not asked for";
  const std::optional<std::string> frame = sensor.input.frame();
  if (!frame) return "no message on " + sensor.topic;
  if (const auto lag = sensor.input.outOfStep()) return sensor.topic + ", out of step: " + *lag;
  if (sensor.extrinsic.pose()) return sensor.topic;
  return sensor.topic + ", no transform from its frame " + *frame + " to the camera's";
}

void LineTrackerNodelet::work() {
  while (const auto message = queue_->pop()) {
    try {
      // Several nodelets share a process, and its stderr.
      track(message->raw ? *message->raw
                         : *decompress(*message->compressed, DecoderWarnings::kArePrinted).toImageMsg());
    } catch (const std::exception& error) {
      drop(DropReason::kUnreadable, error.what());
    }
  }
}

void LineTrackerNodelet::track(const sensor_msgs::Image& image) {
  const std::uint64_t replaced = queue_->replaced();
  const auto stamp_ns = static_cast<std::int64_t>(image.header.stamp.toNSec());
  double mono16_scale = 0.0;
  double patience_s = 0.0;
  std::int64_t imu_stamp_ns = 0;
  {
    const std::lock_guard<std::mutex> lock(tracker_mutex_);
    mono16_scale = parameters_.mono16_scale;
    patience_s = parameters_.imu_wait;
    imu_stamp_ns = tracker_->imuStamp(stamp_ns);
  }
  const auto [gray, problem] = readGray(image, mono16_scale);
  if (!problem.empty()) return drop(DropReason::kUnreadable, problem);
  const CalibrationInput::Model model = calibration_.modelFor(gray.cols, gray.rows);
  if (model.warning) {
    NODELET_WARN("%s: %s", camera_info_topic_.c_str(), model.warning->c_str());
  }
  calibrated_ = model.camera != nullptr;
  const std::string& frame_id = image.header.frame_id;
  if (stamp_ns != 0 && (uses_imu_ || uses_odometry_)) {
    const ros::WallTime begin = ros::WallTime::now();
    if (uses_imu_) await(imu_, imu_subscriber_, imu_stamp_ns, patience_s, frame_id);
    if (uses_odometry_) await(odometry_, odometry_subscriber_, stamp_ns, patience_s, frame_id);
    diagnostics_.addWait((ros::WallTime::now() - begin).toSec());
  }

  const std::lock_guard<std::mutex> lock(tracker_mutex_);
  checkMask(gray.cols, gray.rows);
  tracker_->setCamera(model.camera);
  if (const auto pose = imu_.extrinsic.pose()) {
    tracker_->setImuRotation(pose->linear());
    imu_.input.feed(tracker_->imuStamp(stamp_ns), *tracker_);
  }
  if (const auto pose = odometry_.extrinsic.pose()) {
    tracker_->setOdometryExtrinsic(*pose);
    odometry_.input.feed(stamp_ns, *tracker_);
  }
  const FrameResult result = tracker_->process(gray, stamp_ns);
  if (isDropped(result.verdict)) {
    const Drop dropped = dropOf(result.verdict);
    return drop(dropped.reason, dropped.sentence);
  }
  const LineFrame& frame = *result.frame;
  if (epoch_ != 0 && epoch_ != frame.epoch) {
    NODELET_INFO("epoch %u begins at stamp %.6f", frame.epoch, image.header.stamp.toSec());
  }
  epoch_ = frame.epoch;
  diagnostics_.addTracked(frame);
  diagnostics_.setGyroBias(tracker_->gyroBias());
  publisher_->setCamera(model.camera);
  if (publisher_->publish(frame, frame_id, gray, replaced)) {
    diagnostics_.addPublished((ros::Time::now() - image.header.stamp).toSec());
  }
}

/// Without tracker_mutex_, so that a reset need not wait with the image. An image does not wait so long that
/// another one may lose its place in the queue while it is tracked.
template <class Sample>
void LineTrackerNodelet::await(MotionSensor<Sample>& sensor, const ros::Subscriber& subscriber,
                               std::int64_t stamp_ns, double patience_s, const std::string& camera_frame) {
  if (!sensor.input.frame() && subscriber.getNumPublishers() == 0) return;
  const auto crowded = [this] { return queue_->isHalfFull(); };
  if (sensor.extrinsic.isHopeful() && !sensor.input.waitFor(stamp_ns, patience_s, crowded)) {
    if (sensor.extrinsic.pose()) diagnostics_.addWithoutSamples();
  }
  warnOfLag(sensor);
  const std::optional<std::string> frame = sensor.input.frame();
  if (!frame) return;
  if (const auto warning = sensor.extrinsic.find(tf_buffer_, *frame, camera_frame, patience_s, crowded)) {
    NODELET_WARN("%s: %s", sensor.topic.c_str(), warning->c_str());
  }
}

template <class Sample>
void LineTrackerNodelet::warnOfLag(MotionSensor<Sample>& sensor) {
  const std::optional<std::string> lag = sensor.input.outOfStep();
  if (lag && !sensor.warned && sensor.warning.isDue()) {
    sensor.warned = true;
    NODELET_WARN("%s is out of step: %s; images do not wait for it, their motion is predicted without",
                 sensor.topic.c_str(), lag->c_str());
  } else if (!lag && sensor.warned) {
    sensor.warned = false;
    NODELET_INFO("%s is in step again", sensor.topic.c_str());
  }
}

void LineTrackerNodelet::checkMask(int width, int height) {
  const std::string problem = maskComplaint(mask_, width, height);
  if (problem.empty() || !mask_warning_.isDue()) return;
  NODELET_ERROR("%s: %s; lines are tracked in the whole image", parameters_.mask.c_str(), problem.c_str());
}

void LineTrackerNodelet::drop(DropReason reason, const std::string& sentence) {
  const std::uint64_t count = diagnostics_.addDropped(reason);
  if (!drop_warnings_[static_cast<std::size_t>(reason)].isDue()) return;
  NODELET_ERROR("image of %s dropped (%llu so far): %s", image_topic_.c_str(),
                static_cast<unsigned long long>(count), sentence.c_str());
}

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::LineTrackerNodelet, nodelet::Nodelet)
