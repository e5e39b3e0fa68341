#include "sequence_bag.h"

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include "../ros/camera_info.h"

namespace tet_line_tracker {
namespace {

geometry_msgs::TransformStamped transformMessage(const ros::Time& stamp, const char* parent,
                                                 const char* child,
                                                 const Eigen::Isometry3d& parent_from_child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  const Eigen::Vector3d t = parent_from_child.translation();
  const Eigen::Quaterniond q(parent_from_child.rotation());
  message.transform.translation.x = t.x();
  message.transform.translation.y = t.y();
  message.transform.translation.z = t.z();
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  message.transform.rotation.w = q.w();
  return message;
}

}  // namespace

const ros::Duration SequenceBag::kCameraInfoLead(0.1);

SequenceBag::SequenceBag(const std::string& path, std::optional<CameraCalibration> camera,
                         const std::optional<Eigen::Isometry3d>& camera_from_imu,
                         const ros::Time& first_stamp,
                         const std::optional<Eigen::Isometry3d>& camera_from_body)
    : writer_(path), camera_(std::move(camera)) {
  tf2_msgs::TFMessage message;
  if (camera_from_imu) {
    imu_from_camera_ = camera_from_imu->inverse();
    message.transforms.push_back(transformMessage(first_stamp, sequence_bag::kImuFrame,
                                                  sequence_bag::kCameraFrame, *imu_from_camera_));
  }
  if (camera_from_body) {
    message.transforms.push_back(transformMessage(first_stamp, sequence_bag::kCameraFrame,
                                                  sequence_bag::kBodyFrame, *camera_from_body));
  }
  if (!message.transforms.empty()) {
    writer_.write(sequence_bag::kStaticTfTopic, first_stamp, message, true);
  }
}

void SequenceBag::writeImage(const ros::Time& stamp, const cv::Mat& image) {
  namespace enc = sensor_msgs::image_encodings;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = sequence_bag::kCameraFrame;
  if (camera_) {
    sensor_msgs::CameraInfo info = toCameraInfo(*camera_);
    info.header = header;
    if (first_image_ && stamp.toSec() > kCameraInfoLead.toSec()) {
      writer_.write(sequence_bag::kCameraInfoTopic, stamp - kCameraInfoLead, info);
    }
    writer_.write(sequence_bag::kCameraInfoTopic, stamp, info);
  }
  first_image_ = false;
  const std::string encoding = image.type() == CV_8UC1   ? enc::MONO8
                               : image.type() == CV_8UC3 ? enc::BGR8
                                                         : enc::MONO16;
  writer_.write(sequence_bag::kImageTopic, stamp, *cv_bridge::CvImage(header, encoding, image).toImageMsg());
}

void SequenceBag::writeDepth(const ros::Time& stamp, const cv::Mat& depth_mm) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = sequence_bag::kCameraFrame;
  writer_.write(sequence_bag::kDepthTopic, stamp,
                *cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_16UC1, depth_mm).toImageMsg());
}

void SequenceBag::writeImu(const ros::Time& stamp, const Eigen::Vector3d& angular_velocity,
                           const Eigen::Vector3d& acceleration) {
  sensor_msgs::Imu message;
  message.header.stamp = stamp;
  message.header.frame_id = sequence_bag::kImuFrame;
  message.orientation_covariance[0] = -1.0;  // no orientation, as sensor_msgs/Imu asks
  message.angular_velocity.x = angular_velocity.x();
  message.angular_velocity.y = angular_velocity.y();
  message.angular_velocity.z = angular_velocity.z();
  message.linear_acceleration.x = acceleration.x();
  message.linear_acceleration.y = acceleration.y();
  message.linear_acceleration.z = acceleration.z();
  writer_.write(sequence_bag::kImuTopic, stamp, message);
}

void SequenceBag::writeOdometry(const ros::Time& stamp, const Eigen::Isometry3d& odometry_from_body) {
  const geometry_msgs::TransformStamped transform =
      transformMessage(stamp, sequence_bag::kOdometryFrame, sequence_bag::kBodyFrame, odometry_from_body);
  nav_msgs::Odometry message;
  message.header = transform.header;
  message.child_frame_id = transform.child_frame_id;
  message.pose.pose.position.x = transform.transform.translation.x;
  message.pose.pose.position.y = transform.transform.translation.y;
  message.pose.pose.position.z = transform.transform.translation.z;
  message.pose.pose.orientation = transform.transform.rotation;
  writer_.write(sequence_bag::kOdometryTopic, stamp, message);
}

void SequenceBag::writePose(const ros::Time& stamp, const Eigen::Isometry3d& world_from_camera) {
  const geometry_msgs::TransformStamped camera =
      transformMessage(stamp, sequence_bag::kWorldFrame, sequence_bag::kCameraFrame, world_from_camera);
  geometry_msgs::PoseStamped pose;
  pose.header = camera.header;
  pose.pose.position.x = camera.transform.translation.x;
  pose.pose.position.y = camera.transform.translation.y;
  pose.pose.position.z = camera.transform.translation.z;
  pose.pose.orientation = camera.transform.rotation;
  writer_.write(sequence_bag::kPoseTopic, stamp, pose);

  // A frame has one parent: the camera hangs on the IMU where there is one.
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(imu_from_camera_
                              ? transformMessage(stamp, sequence_bag::kWorldFrame, sequence_bag::kImuFrame,
                                                 world_from_camera * imu_from_camera_->inverse())
                              : camera);
  writer_.write(sequence_bag::kTfTopic, stamp, tf);
}

}  // namespace tet_line_tracker
