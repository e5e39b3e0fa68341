#include "imu_input.h"

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace tet_line_tracker {
namespace {

sensor_msgs::Imu messageAt(double stamp_s) {
  sensor_msgs::Imu message;
  message.header.stamp = ros::Time(stamp_s);
  message.header.frame_id = "imu";
  return message;
}

std::int64_t ns(double seconds) {
  return static_cast<std::int64_t>(ros::Time(seconds).toNSec());
}

TEST(ImuInput, AnImageIsCoveredOnceAMessageAtOrAfterItHasCome) {
  ImuInput imu;
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.0));
  imu.add(messageAt(9.99));
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.0));
  imu.add(messageAt(10.0));
  EXPECT_TRUE(imu.waitFor(ns(10.0), 0.0));
  EXPECT_EQ(imu.frame(), "imu");
}

TEST(ImuInput, StaysCoveredByWhatTheTrackerAlreadyHas) {
  LineTracker tracker(LineTrackerParameters{});
  ImuInput imu;
  imu.add(messageAt(10.0));
  imu.add(messageAt(10.02));
  imu.feed(ns(10.01), tracker);
  EXPECT_TRUE(imu.waitFor(ns(10.015), 0.0));
  EXPECT_FALSE(imu.waitFor(ns(10.03), 0.0));
}

TEST(ImuInput, WaitsForAMessageThatIsOnItsWay) {
  ImuInput imu;
  std::thread later([&imu] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    imu.add(messageAt(10.01));
  });
  EXPECT_TRUE(imu.waitFor(ns(10.0), 60.0));
  later.join();
}

TEST(ImuInput, ASilentImuIsWaitedForOnceOnly) {
  ImuInput imu;
  imu.add(messageAt(9.0));
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.001));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(imu.waitFor(ns(10.05), 60.0));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST(ImuInput, ABagThatBeginsAnewServesTheLastImagesOfTheOldRoundAndTheFirstOfTheNew) {
  LineTracker tracker(LineTrackerParameters{});
  ImuInput imu;
  for (const double stamp : {99.0, 99.01, 99.02, 1.0, 1.01, 1.02}) imu.add(messageAt(stamp));
  EXPECT_TRUE(imu.waitFor(ns(99.015), 0.0));
  imu.feed(ns(99.015), tracker);
  // The old round is over: waiting would be in vain.
  EXPECT_FALSE(imu.waitFor(ns(99.03), 60.0));
  imu.feed(ns(99.03), tracker);
  EXPECT_TRUE(imu.waitFor(ns(1.005), 0.0));
  imu.feed(ns(1.005), tracker);
  EXPECT_TRUE(imu.waitFor(ns(1.02), 0.0));
  EXPECT_FALSE(imu.waitFor(ns(1.03), 0.0));
}

TEST(ImuRotation, FollowsTheChainOfFrames) {
  // camera <- body -> imu: the camera is turned by a quarter about z, the IMU by a quarter about x.
  tf2::BufferCore frames;
  const auto add = [&frames](const char* child, const Eigen::Quaterniond& parent_from_child) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "body";
    transform.child_frame_id = child;
    transform.transform.rotation.x = parent_from_child.x();
    transform.transform.rotation.y = parent_from_child.y();
    transform.transform.rotation.z = parent_from_child.z();
    transform.transform.rotation.w = parent_from_child.w();
    frames.setTransform(transform, "test", true);
  };
  const Eigen::Quaterniond body_from_camera(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond body_from_imu(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX()));
  add("camera", body_from_camera);
  EXPECT_FALSE(imuRotation(frames, "imu", "camera"));
  add("imu", body_from_imu);
  const auto rotation = imuRotation(frames, "imu", "camera");
  ASSERT_TRUE(rotation);
  EXPECT_TRUE(rotation->isApprox((body_from_camera.conjugate() * body_from_imu).toRotationMatrix(), 1e-9));
  EXPECT_FALSE(imuRotation(frames, "", "camera"));
}

TEST(ImuRotation, AQuaternionIsReadAndAnythingElseRefused) {
  EXPECT_FALSE(imuRotation(std::string()));
  const auto rotation = imuRotation(std::string("0 0 0.70710678 0.70710678"));
  ASSERT_TRUE(rotation);
  EXPECT_LT((*rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  for (const char* wrong : {"1 2 3", "0 0 0 1 5", "0 0 0 2", "none", "0 0 0 nan"}) {
    EXPECT_THROW(imuRotation(std::string(wrong)), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace tet_line_tracker
