#pragma once

#include <cstdint>
#include <string>

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <Eigen/Geometry>

#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {

/// What a gyroscope measures.
struct AngularVelocity {
  std::int64_t stamp_ns;
  Eigen::Vector3d rad_per_s;  ///< in the IMU's frame
};

/// What an odometry tells.
struct BodyPose {
  std::int64_t stamp_ns;
  Eigen::Isometry3d odometry_from_body;  ///< [m]; without a quaternion of a length near one: NaN
};

AngularVelocity toSample(const sensor_msgs::Imu& message);
BodyPose toSample(const nav_msgs::Odometry& message);

/// The frame that moves with the camera.
inline const std::string& frameOf(const sensor_msgs::Imu& message) {
  return message.header.frame_id;
}
inline const std::string& frameOf(const nav_msgs::Odometry& message) {
  return message.child_frame_id;
}

void give(const AngularVelocity& sample, LineTracker& tracker);
void give(const BodyPose& sample, LineTracker& tracker);

}  // namespace tet_line_tracker
