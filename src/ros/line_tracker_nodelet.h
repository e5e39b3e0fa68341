#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>
#include <tf2_ros/transform_listener.h>

#include "calibration_input.h"
#include "imu_input.h"
#include "markers.h"
#include "newest_queue.h"
#include "node_parameters.h"
#include "publish_throttle.h"
#include "stream_diagnostics.h"
#include "tet_line_tracker/display/track_painter.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {

/// The front end as a nodelet. The callback of an image only puts it into a short queue; one worker thread
/// takes the images in their order, tracks and publishes. Nothing in a message depends on the wall clock.
class LineTrackerNodelet : public nodelet::Nodelet {
 public:
  ~LineTrackerNodelet() override;

 private:
  void onInit() override;
  void loadParameters();
  void advertise();
  void subscribe();

  // In the callback queue of the nodelet, one at a time.
  void onImage(const sensor_msgs::ImageConstPtr& image);
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& info);
  void onImu(const sensor_msgs::ImuConstPtr& message);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onTimer(const ros::WallTimerEvent& event);
  void warnOfSilence();
  std::string imuState() const;
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  // In the worker thread.
  void work();
  void track(const sensor_msgs::ImageConstPtr& image);
  void awaitImu(const std_msgs::Header& image);
  void findImuRotation(const std::string& camera_frame);
  void checkMask(int width, int height);
  void publish(const LineFrame& frame, const cv::Mat& gray, const sensor_msgs::Image& image);
  void dropByStamp(StreamVerdict verdict);
  void drop(DropReason reason, const std::string& sentence);

  LineTrackerParameters tracker_parameters_;
  NodeParameters parameters_;

  std::mutex tracker_mutex_;  ///< guards tracker_ and what it gives out; held by the worker for a whole image
  std::unique_ptr<LineTracker> tracker_;
  std::unique_ptr<NewestQueue<sensor_msgs::ImageConstPtr>> queue_;
  CalibrationInput calibration_;
  ImuInput imu_;
  tf2::BufferCore frames_;
  StreamDiagnostics diagnostics_;

  // Only the worker uses these.
  std::unique_ptr<PublishThrottle> throttle_;
  std::unique_ptr<MarkerBuilder> markers_;
  TrackPainter painter_;
  std::optional<Eigen::Matrix3d> imu_rotation_;
  int images_without_rotation_{0};
  cv::Mat mask_;
  cv::Size mask_told_;  ///< size of the images that the mask did not fit
  std::optional<std::uint32_t> epoch_;
  std::uint64_t replaced_before_epoch_{0};
  std::uint32_t lines_sequence_{0};
  std::uint32_t statistics_sequence_{0};
  std::array<ros::WallTime, static_cast<std::size_t>(DropReason::kCount)> drop_told_;

  std::atomic<bool> calibrated_{false};
  std::atomic<bool> imu_rotation_known_{false};
  ros::WallTime silence_told_;  ///< only the timer uses it

  ros::Publisher lines_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher statistics_publisher_;
  image_transport::Publisher debug_image_publisher_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  std::thread worker_;

  // Last, so that no callback comes while the rest is being destroyed.
  ros::ServiceServer reset_server_;
  ros::WallTimer timer_;
  std::unique_ptr<tf2_ros::TransformListener> frames_listener_;
  ros::Subscriber imu_subscriber_;
  ros::Subscriber camera_info_subscriber_;
  image_transport::Subscriber image_subscriber_;
};

}  // namespace tet_line_tracker
