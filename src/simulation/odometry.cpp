#include "odometry.h"

#include <cmath>

namespace tet_line_tracker {
namespace {

constexpr double kScaleError = 0.01;     // deviation
constexpr double kHeadingDrift = 0.002;  // deviation [rad/s]
constexpr double kHeadingNoise = 2e-4;   // of each step, deviation [rad]
constexpr double kWayNoise = 0.005;      // of each step, deviation, share of the way

}  // namespace

Eigen::Isometry3d defaultCameraFromBody(bool car) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0.0, -1.0, 0.0,  //
      0.0, 0.0, -1.0,               //
      1.0, 0.0, 0.0;
  pose.translation() = car ? Eigen::Vector3d(0.0, 1.65, -1.0) : Eigen::Vector3d(0.0, 0.1, -0.05);
  return pose;
}

SimulatedOdometry::SimulatedOdometry(const Trajectory& trajectory, bool car, std::uint64_t seed,
                                     double start_s)
    : trajectory_(trajectory),
      car_(car),
      camera_from_body_(defaultCameraFromBody(car)),
      random_(seed, 6),
      scale_(1.0 + kScaleError * random_.normal()),
      drift_(kHeadingDrift * random_.normal()),
      time_s_(start_s) {}

const Eigen::Isometry3d& SimulatedOdometry::advance(double time_s) {
  const Eigen::Isometry3d before = trajectory_.worldFromCamera(time_s_) * camera_from_body_;
  const Eigen::Isometry3d now = trajectory_.worldFromCamera(time_s) * camera_from_body_;
  Eigen::Isometry3d step = before.inverse() * now;
  if (car_) {
    const double heading = std::atan2(step.linear()(1, 0), step.linear()(0, 0));
    step = Eigen::Isometry3d(Eigen::Translation3d(step.translation().x(), 0.0, 0.0));
    step.rotate(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  }
  step.translation() *= scale_ + kWayNoise * random_.normal();
  step.rotate(Eigen::AngleAxisd(drift_ * (time_s - time_s_) + kHeadingNoise * random_.normal(),
                                Eigen::Vector3d::UnitZ()));
  pose_ = pose_ * step;
  pose_.linear() = Eigen::Quaterniond(pose_.linear()).normalized().toRotationMatrix();
  time_s_ = time_s;
  return pose_;
}

}  // namespace tet_line_tracker
