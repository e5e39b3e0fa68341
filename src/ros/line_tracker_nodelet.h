#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/Odometry.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>
#include <tf2_ros/transform_listener.h>

#include "calibration_input.h"
#include "image_subscription.h"
#include "line_publisher.h"
#include "newest_queue.h"
#include "node_parameters.h"
#include "reconfigure_server.h"
#include "sensor_extrinsic.h"
#include "sensor_input.h"
#include "silence_warning.h"
#include "stream_diagnostics.h"
#include "tet_line_tracker/tracking/line_tracker.h"
#include "throttled_warning.h"

namespace tet_line_tracker {

/// A sensor that tells how the camera moves, and what is known of it.
template <class Sample>
struct MotionSensor {
  MotionSensor(const std::string& name, const std::string& parameter) : extrinsic(name, parameter) {}

  SensorInput<Sample> input;
  SensorExtrinsic extrinsic;
  std::string topic;
  // Only the worker uses these.
  bool warned{false};  ///< that it is out of step
  ThrottledWarning warning{std::chrono::seconds(60)};
};

/// The front end as a nodelet. The callback of an image only puts it into a short queue; one worker thread
/// takes the images in their order, tracks and publishes. Nothing in a message depends on the wall clock, and
/// nothing in a callback or in the worker waits for the master.
class LineTrackerNodelet : public nodelet::Nodelet {
 public:
  ~LineTrackerNodelet() override;

 private:
  void onInit() override;
  void loadParameters();
  void advertise();
  void subscribe();
  void serveParameters();
  void noteTracker();  ///< for uses_imu_ and what else follows from the parameters; with tracker_mutex_

  // In the callback queue of the nodelet, one at a time.
  void onImage(const ImageMessage& image);
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& info);
  void onImu(const sensor_msgs::ImuConstPtr& message);
  void onOdometry(const nav_msgs::OdometryConstPtr& message);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onTimer(const ros::WallTimerEvent& event);
  template <class Sample>
  std::string stateOf(const MotionSensor<Sample>& sensor, bool used) const;
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  // In the thread of the reconfigure server.
  void applyParameters(const LineTrackerParameters& tracker, const NodeParameters& parameters);

  // In the worker thread.
  void work();
  void track(const sensor_msgs::Image& image);
  /// Waits for the messages of a sensor up to `stamp_ns`, and for its pose, where somebody publishes them.
  template <class Sample>
  void await(MotionSensor<Sample>& sensor, const ros::Subscriber& subscriber, std::int64_t stamp_ns,
             double patience_s, const std::string& camera_frame);
  template <class Sample>
  void warnOfLag(MotionSensor<Sample>& sensor);
  void checkMask(int width, int height);  ///< with tracker_mutex_
  void drop(DropReason reason, const std::string& sentence);

  std::string image_topic_, camera_info_topic_;
  /// Guards what follows, and what tracker_ and publisher_ give out; held by the worker for a whole image.
  std::mutex tracker_mutex_;
  NodeParameters parameters_;
  cv::Mat mask_;
  ThrottledWarning mask_warning_{std::chrono::seconds(60)};
  std::unique_ptr<LineTracker> tracker_;
  std::unique_ptr<LinePublisher> publisher_;

  /// What tracker_ says of itself, for those who must not wait for an image to end.
  std::atomic<bool> uses_imu_{false}, uses_odometry_{false};
  std::unique_ptr<NewestQueue<ImageMessage>> queue_;
  CalibrationInput calibration_;
  MotionSensor<AngularVelocity> imu_{"IMU", "imu_rotation"};
  MotionSensor<BodyPose> odometry_{"odometry", "odometry_extrinsic"};
  tf2::BufferCore tf_buffer_;
  StreamDiagnostics diagnostics_;
  std::atomic<bool> calibrated_{false};

  // Only the worker uses these.
  std::uint32_t epoch_{0};  ///< 0: no image yet
  std::array<ThrottledWarning, static_cast<std::size_t>(DropReason::kCount)> drop_warnings_;

  std::unique_ptr<diagnostic_updater::Updater> updater_;
  std::unique_ptr<SilenceWarning> silence_warning_;  ///< only the timer uses it
  std::thread worker_;

  // Last, so that no callback comes while the rest is being destroyed.
  ros::ServiceServer reset_server_;
  ros::WallTimer timer_;
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  ros::Subscriber imu_subscriber_, odometry_subscriber_;
  ros::Subscriber camera_info_subscriber_;
  std::unique_ptr<ImageSubscription> image_subscription_;
  std::unique_ptr<ReconfigureServer> reconfigure_server_;
};

}  // namespace tet_line_tracker
