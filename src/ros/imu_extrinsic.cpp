#include "imu_extrinsic.h"

#include <ros/time.h>
#include <tf2/exceptions.h>
#include <Eigen/Geometry>

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tet_line_tracker {

std::optional<Eigen::Matrix3d> imuRotation(const tf2::BufferCore& buffer, const std::string& imu_frame,
                                           const std::string& camera_frame) {
  try {
    const auto q = buffer.lookupTransform(camera_frame, imu_frame, ros::Time(0)).transform.rotation;
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

std::optional<Eigen::Matrix3d> imuRotation(const std::string& quaternion) {
  if (quaternion.empty()) return std::nullopt;
  std::istringstream text(quaternion);
  Eigen::Quaterniond q;
  std::string rest;
  if (!(text >> q.x() >> q.y() >> q.z() >> q.w()) || text >> rest || !(std::abs(q.norm() - 1.0) < 0.01)) {
    throw std::invalid_argument("parameter imu_rotation is " + quaternion +
                                ", needs a unit quaternion qx qy qz qw");
  }
  return q.normalized().toRotationMatrix();
}

void ImuExtrinsic::set(const std::optional<Eigen::Matrix3d>& rotation) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rotation_ = rotation;
}

std::optional<Eigen::Matrix3d> ImuExtrinsic::rotation() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rotation_;
}

bool ImuExtrinsic::isHopeful() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rotation_ || images_without_ < kPatienceImages;
}

std::optional<std::string> ImuExtrinsic::find(const tf2::BufferCore& buffer, const std::string& imu_frame,
                                              const std::string& camera_frame, double patience_s,
                                              const std::function<bool()>& is_crowded) {
  if (rotation()) return std::nullopt;
  const bool wait = isHopeful();
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  std::optional<Eigen::Matrix3d> found = imuRotation(buffer, imu_frame, camera_frame);
  while (!found && wait && !is_crowded() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    found = imuRotation(buffer, imu_frame, camera_frame);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  rotation_ = found;
  if (rotation_ || images_without_ >= kPatienceImages || ++images_without_ < kPatienceImages)
    return std::nullopt;
  return "the IMU is not used: after " + std::to_string(kPatienceImages) +
         " images no transform leads from its frame '" + imu_frame + "' to the camera's '" + camera_frame +
         "', and imu_rotation is empty";
}

}  // namespace tet_line_tracker
