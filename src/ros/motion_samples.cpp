#include "motion_samples.h"

#include <cmath>
#include <limits>

namespace tet_line_tracker {

AngularVelocity toSample(const sensor_msgs::Imu& message) {
  const auto& w = message.angular_velocity;
  return {static_cast<std::int64_t>(message.header.stamp.toNSec()), {w.x, w.y, w.z}};
}

BodyPose toSample(const nav_msgs::Odometry& message) {
  const auto& t = message.pose.pose.position;
  const auto& r = message.pose.pose.orientation;
  const Eigen::Quaterniond q(r.w, r.x, r.y, r.z);
  BodyPose sample{static_cast<std::int64_t>(message.header.stamp.toNSec()), Eigen::Isometry3d::Identity()};
  sample.odometry_from_body.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  if (std::abs(q.norm() - 1.0) < 0.01) {  // written so that NaN fails
    sample.odometry_from_body.linear() = q.normalized().toRotationMatrix();
  } else {
    sample.odometry_from_body.linear().setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return sample;
}

void give(const AngularVelocity& sample, LineTracker& tracker) {
  tracker.addAngularVelocity(sample.stamp_ns, sample.rad_per_s);
}

void give(const BodyPose& sample, LineTracker& tracker) {
  tracker.addOdometry(sample.stamp_ns, sample.odometry_from_body);
}

}  // namespace tet_line_tracker
