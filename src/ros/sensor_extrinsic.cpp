#include "sensor_extrinsic.h"

#include <ros/time.h>
#include <tf2/exceptions.h>
#include <Eigen/Geometry>

#include <chrono>
#include <cmath>
#include <istream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace tet_line_tracker {

namespace {

/// A quaternion, if the next four numbers of `text` are one.
std::optional<Eigen::Quaterniond> readQuaternion(std::istream& text) {
  Eigen::Quaterniond q;
  if (!(text >> q.x() >> q.y() >> q.z() >> q.w()) || !(std::abs(q.norm() - 1.0) < 0.01)) return std::nullopt;
  return q.normalized();
}

bool hasMore(std::istream& text) {
  std::string rest;
  return static_cast<bool>(text >> rest);
}

}  // namespace

std::optional<Eigen::Isometry3d> sensorPose(const tf2::BufferCore& buffer, const std::string& sensor_frame,
                                            const std::string& camera_frame) {
  if (sensor_frame.empty() || camera_frame.empty()) return std::nullopt;  // not the same frame, but no name
  try {
    const auto transform = buffer.lookupTransform(camera_frame, sensor_frame, ros::Time(0)).transform;
    const auto& q = transform.rotation;
    const auto& t = transform.translation;
    return Eigen::Translation3d(t.x, t.y, t.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

std::optional<Eigen::Isometry3d> imuRotation(const std::string& quaternion) {
  if (quaternion.empty()) return std::nullopt;
  std::istringstream text(quaternion);
  const std::optional<Eigen::Quaterniond> q = readQuaternion(text);
  if (!q || hasMore(text)) {
    throw std::invalid_argument("parameter imu_rotation is " + quaternion +
                                ", needs a unit quaternion qx qy qz qw");
  }
  return Eigen::Isometry3d(*q);
}

std::optional<Eigen::Isometry3d> odometryExtrinsic(const std::string& pose) {
  if (pose.empty()) return std::nullopt;
  std::istringstream text(pose);
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  text >> t.x() >> t.y() >> t.z();
  const std::optional<Eigen::Quaterniond> q = readQuaternion(text);
  if (!q || !t.allFinite() || hasMore(text)) {
    throw std::invalid_argument("parameter odometry_extrinsic is " + pose +
                                ", needs a position [m] and a unit quaternion x y z qx qy qz qw");
  }
  return Eigen::Translation3d(t) * *q;
}

SensorExtrinsic::SensorExtrinsic(std::string sensor, std::string parameter)
    : sensor_(std::move(sensor)), parameter_(std::move(parameter)) {}

void SensorExtrinsic::set(const std::optional<Eigen::Isometry3d>& pose) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pose_ = pose;
}

std::optional<Eigen::Isometry3d> SensorExtrinsic::pose() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return pose_;
}

bool SensorExtrinsic::isHopeful() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return pose_ || images_without_ < kPatienceImages;
}

std::optional<std::string> SensorExtrinsic::find(const tf2::BufferCore& buffer,
                                                 const std::string& sensor_frame,
                                                 const std::string& camera_frame, double patience_s,
                                                 const std::function<bool()>& is_crowded) {
  if (pose()) return std::nullopt;
  const bool wait = isHopeful();
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  std::optional<Eigen::Isometry3d> found = sensorPose(buffer, sensor_frame, camera_frame);
  while (!found && wait && !is_crowded() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    found = sensorPose(buffer, sensor_frame, camera_frame);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  pose_ = found;
  if (pose_ || images_without_ >= kPatienceImages || ++images_without_ < kPatienceImages) return std::nullopt;
  return "the " + sensor_ + " is not used: after " + std::to_string(kPatienceImages) +
         " images no transform leads from its frame '" + sensor_frame + "' to the camera's '" + camera_frame +
         "', and " + parameter_ + " is empty";
}

}  // namespace tet_line_tracker
