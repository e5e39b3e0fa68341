#pragma once

#include <optional>
#include <string>

#include <ros/time.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "bag_writer.h"
#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Topics and frames of the bags that dataset_to_bag and simulate_bag write.
namespace sequence_bag {
constexpr char kImageTopic[] = "/cam0/image_raw";
constexpr char kCameraInfoTopic[] = "/cam0/camera_info";
constexpr char kDepthTopic[] = "/depth/image_raw";
constexpr char kImuTopic[] = "/imu0";
constexpr char kOdometryTopic[] = "/odom";
constexpr char kPoseTopic[] = "/ground_truth/pose";
constexpr char kTfTopic[] = "/tf";
constexpr char kStaticTfTopic[] = "/tf_static";
constexpr char kLinesTopic[] = "/line_tracker/lines";
constexpr char kMapTopic[] = "/line_mapper/lines";
constexpr char kMapMarkerTopic[] = "/line_mapper/markers";
constexpr char kTrueEdgesTopic[] = "/ground_truth/edges";
constexpr char kWorldFrame[] = "world";
constexpr char kCameraFrame[] = "cam0";
constexpr char kImuFrame[] = "imu0";
constexpr char kOdometryFrame[] = "odom";
constexpr char kBodyFrame[] = "base_link";
}  // namespace sequence_bag

/// Writes one camera's sequence with calibration, IMU and ground truth. Call in the order of stamps per
/// topic.
class SequenceBag {
 public:
  /// `camera_from_imu`, `camera_from_body`: poses of the IMU and of base_link in the camera's optical frame;
  /// they go to /tf_static before anything else.
  SequenceBag(const std::string& path, std::optional<CameraCalibration> camera,
              const std::optional<Eigen::Isometry3d>& camera_from_imu, const ros::Time& first_stamp,
              const std::optional<Eigen::Isometry3d>& camera_from_body = std::nullopt);

  /// Image (8UC1, 8UC3 as BGR, or 16UC1) with its camera_info just before it, under the same stamp. The first
  /// camera_info comes kCameraInfoLead before the first image as well, so that a live node knows it in time.
  void writeImage(const ros::Time& stamp, const cv::Mat& image);
  /// Depth, 16UC1 [mm], 0: unknown.
  void writeDepth(const ros::Time& stamp, const cv::Mat& depth_mm);
  /// Angular velocity [rad/s] and specific force [m/s^2] in the IMU's frame.
  void writeImu(const ros::Time& stamp, const Eigen::Vector3d& angular_velocity,
                const Eigen::Vector3d& acceleration);
  /// Pose of base_link in odom [m].
  void writeOdometry(const ros::Time& stamp, const Eigen::Isometry3d& odometry_from_body);
  /// Pose of the camera in `world`, as /ground_truth/pose and on /tf.
  void writePose(const ros::Time& stamp, const Eigen::Isometry3d& world_from_camera);
  /// Any further message.
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    writer_.write(topic, stamp, message);
  }
  void close() { writer_.close(); }

  static const ros::Duration kCameraInfoLead;

 private:
  BagWriter writer_;
  std::optional<CameraCalibration> camera_;
  std::optional<Eigen::Isometry3d> imu_from_camera_;
  bool first_image_{true};
};

}  // namespace tet_line_tracker
