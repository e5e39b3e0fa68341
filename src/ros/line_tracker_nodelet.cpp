#include "line_tracker_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

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
}

void LineTrackerNodelet::loadParameters() {
  tet_line_tracker::loadParameters(getPrivateNodeHandle(), tracker_parameters_, parameters_);
  checkImageTransport(getNodeHandle(), getPrivateNodeHandle());
  tracker_ = std::make_unique<LineTracker>(tracker_parameters_);
  mask_ = readMask(parameters_.mask);
  tracker_->setMask(mask_);
  imu_.extrinsic.set(imuRotation(parameters_.imu_rotation));
  odometry_.extrinsic.set(odometryExtrinsic(parameters_.odometry_extrinsic));
  queue_ = std::make_unique<NewestQueue<sensor_msgs::ImageConstPtr>>(parameters_.queue_size);
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
  image_topic_ = node.resolveName("image");
  if (hints.getTransport() != "raw") image_topic_ += "/" + hints.getTransport();
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
  image_subscriber_ = image_transport::ImageTransport(node).subscribe(
      "image", kTransportQueue, &LineTrackerNodelet::onImage, this, hints);
  // The wall clock: simulated time stands still exactly when there is something to warn of.
  timer_ = node.createWallTimer(ros::WallDuration(1.0), &LineTrackerNodelet::onTimer, this);
  NODELET_INFO("tracks lines of %s (%s), method %s, detector %s", image_topic_.c_str(),
               image_subscriber_.getTransport().c_str(), tracker_parameters_.method.c_str(),
               tracker_->detectorName().c_str());
  for (const std::string& note : tracker_->notes()) NODELET_WARN("%s", note.c_str());
}

void LineTrackerNodelet::onImage(const sensor_msgs::ImageConstPtr& image) {
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
  if (tracker_->usesImu()) imu_.input.add(*message);
}

void LineTrackerNodelet::onOdometry(const nav_msgs::OdometryConstPtr& message) {
  if (tracker_->usesOdometry()) odometry_.input.add(*message);
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
                 image_topic_.c_str(), image_subscriber_.getNumPublishers(), topics->c_str());
  }
}

void LineTrackerNodelet::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  StreamDiagnostics::Setup setup;
  setup.image_topic = image_topic_;
  setup.detector = tracker_->detectorName();
  setup.calibration = calibration_.state();
  setup.calibrated = calibrated_;
  setup.imu = stateOf(imu_, tracker_->usesImu());
  setup.odometry = stateOf(odometry_, tracker_->usesOdometry());
  setup.imu_in_step = !imu_.input.outOfStep();
  setup.odometry_in_step = !odometry_.input.outOfStep();
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
  while (const auto image = queue_->pop()) {
    try {
      track(**image);
    } catch (const std::exception& error) {
      drop(DropReason::kUnreadable, error.what());
    }
  }
}

void LineTrackerNodelet::track(const sensor_msgs::Image& image) {
  const std::uint64_t replaced = queue_->replaced();
  const auto [gray, problem] = readGray(image, parameters_.mono16_scale);
  if (!problem.empty()) return drop(DropReason::kUnreadable, problem);
  const auto stamp_ns = static_cast<std::int64_t>(image.header.stamp.toNSec());
  const CalibrationInput::Model model = calibration_.modelFor(gray.cols, gray.rows);
  if (model.warning) {
    NODELET_WARN("%s: %s", camera_info_topic_.c_str(), model.warning->c_str());
  }
  calibrated_ = model.camera != nullptr;
  checkMask(gray.cols, gray.rows);
  const std::string& frame_id = image.header.frame_id;
  if (stamp_ns != 0) {
    if (tracker_->usesImu()) await(imu_, imu_subscriber_, tracker_->imuStamp(stamp_ns), frame_id);
    if (tracker_->usesOdometry()) await(odometry_, odometry_subscriber_, stamp_ns, frame_id);
  }

  const std::lock_guard<std::mutex> lock(tracker_mutex_);
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
  diagnostics_.addTracked(frame, frame.statistics.total_ms);
  publisher_->setCamera(model.camera);
  if (publisher_->publish(frame, frame_id, gray, replaced)) diagnostics_.addPublished();
}

/// Without tracker_mutex_, so that a reset need not wait with the image. An image that would cost another one
/// its place in the queue does not wait.
template <class Sample>
void LineTrackerNodelet::await(MotionSensor<Sample>& sensor, const ros::Subscriber& subscriber,
                               std::int64_t stamp_ns, const std::string& camera_frame) {
  if (!sensor.input.frame() && subscriber.getNumPublishers() == 0) return;
  const auto crowded = [this] { return queue_->isFull(); };
  if (sensor.extrinsic.isHopeful() && !sensor.input.waitFor(stamp_ns, parameters_.imu_wait, crowded)) {
    if (sensor.extrinsic.pose()) diagnostics_.addWithoutSamples();
  }
  warnOfLag(sensor);
  const std::optional<std::string> frame = sensor.input.frame();
  if (!frame) return;
  if (const auto warning =
          sensor.extrinsic.find(tf_buffer_, *frame, camera_frame, parameters_.imu_wait, crowded)) {
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
