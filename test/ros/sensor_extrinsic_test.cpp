#include "sensor_extrinsic.h"

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <stdexcept>
#include <string>
#include <thread>

namespace tet_line_tracker {
namespace {

/// A tf message that says: `child` lies in `body` without rotation.
geometry_msgs::TransformStamped identity(const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "body";
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1.0;
  return transform;
}

TEST(SensorPose, FollowsTheChainOfFrames) {
  // camera <- body -> imu: the camera is turned by a quarter about z, the IMU by a quarter about x.
  tf2::BufferCore buffer;
  const auto add = [&buffer](const char* child, const Eigen::Quaterniond& parent_from_child) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "body";
    transform.child_frame_id = child;
    if (child == std::string("imu")) {
      transform.transform.translation.x = 1.0;
      transform.transform.translation.y = 2.0;
      transform.transform.translation.z = -3.0;
    }
    transform.transform.rotation.x = parent_from_child.x();
    transform.transform.rotation.y = parent_from_child.y();
    transform.transform.rotation.z = parent_from_child.z();
    transform.transform.rotation.w = parent_from_child.w();
    buffer.setTransform(transform, "test", true);
  };
  const Eigen::Quaterniond body_from_camera(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond body_from_imu(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX()));
  add("camera", body_from_camera);
  EXPECT_FALSE(sensorPose(buffer, "imu", "camera"));
  add("imu", body_from_imu);
  const auto pose = sensorPose(buffer, "imu", "camera");
  ASSERT_TRUE(pose);
  EXPECT_TRUE(
      pose->linear().isApprox((body_from_camera.conjugate() * body_from_imu).toRotationMatrix(), 1e-9));
  EXPECT_TRUE(pose->translation().isApprox(body_from_camera.conjugate() * Eigen::Vector3d(1.0, 2.0, -3.0)));
  EXPECT_FALSE(sensorPose(buffer, "", "camera"));
  EXPECT_FALSE(sensorPose(buffer, "", ""));
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

TEST(OdometryExtrinsic, APoseIsReadAndAnythingElseRefused) {
  EXPECT_FALSE(odometryExtrinsic(""));
  const auto pose = odometryExtrinsic("1 2 3 0 0 0.70710678 0.70710678");
  ASSERT_TRUE(pose);
  EXPECT_LT((*pose * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1.0, 3.0, 3.0)).norm(), 1e-6);
  for (const char* wrong : {"0 0 0 1", "1 2 3 0 0 0 2", "1 2 3 0 0 0 1 4", "nan 0 0 0 0 0 1", "none"}) {
    EXPECT_THROW(odometryExtrinsic(wrong), std::invalid_argument) << wrong;
  }
}

TEST(SensorExtrinsic, APoseThatIsGivenNeedsNoTf) {
  SensorExtrinsic extrinsic("IMU", "imu_rotation");
  const Eigen::Isometry3d given(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  extrinsic.set(given);
  const tf2::BufferCore empty;
  for (int i = 0; i < 2 * SensorExtrinsic::kPatienceImages; ++i) {
    EXPECT_FALSE(extrinsic.find(empty, "imu", "camera", 600.0));
  }
  ASSERT_TRUE(extrinsic.pose());
  EXPECT_EQ(extrinsic.pose()->matrix(), given.matrix());
}

TEST(SensorExtrinsic, WarnsOnceThatNoTransformConnectsTheFrames) {
  SensorExtrinsic extrinsic("IMU", "imu_rotation");
  const tf2::BufferCore empty;
  int warnings = 0;
  for (int i = 1; i <= 5 * SensorExtrinsic::kPatienceImages; ++i) {
    EXPECT_EQ(extrinsic.isHopeful(), i <= SensorExtrinsic::kPatienceImages);
    // After the patience it is only asked: waits of ten minutes each would not end.
    const double patience_s = i <= SensorExtrinsic::kPatienceImages ? 0.0 : 600.0;
    const auto warning = extrinsic.find(empty, "my_imu", "my_camera", patience_s);
    if (!warning) continue;
    ++warnings;
    EXPECT_EQ(i, SensorExtrinsic::kPatienceImages);
    EXPECT_NE(warning->find("'my_imu'"), std::string::npos) << *warning;
    EXPECT_NE(warning->find("'my_camera'"), std::string::npos) << *warning;
    EXPECT_NE(warning->find("imu_rotation"), std::string::npos) << *warning;
  }
  EXPECT_EQ(warnings, 1);
  EXPECT_FALSE(extrinsic.pose());
}

TEST(SensorExtrinsic, TakesATransformThatComesLate) {
  SensorExtrinsic extrinsic("IMU", "imu_rotation");
  tf2::BufferCore buffer;
  for (int i = 0; i < 2 * SensorExtrinsic::kPatienceImages; ++i) extrinsic.find(buffer, "imu", "camera", 0.0);
  buffer.setTransform(identity("imu"), "test", true);
  buffer.setTransform(identity("camera"), "test", true);
  EXPECT_FALSE(extrinsic.find(buffer, "imu", "camera", 0.0));
  EXPECT_TRUE(extrinsic.pose());
  EXPECT_TRUE(extrinsic.isHopeful());
}

TEST(SensorExtrinsic, TheFirstImagesWaitForTheTransform) {
  SensorExtrinsic extrinsic("IMU", "imu_rotation");
  tf2::BufferCore buffer;
  buffer.setTransform(identity("imu"), "test", true);
  std::thread later([&buffer] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    buffer.setTransform(identity("camera"), "test", true);
  });
  EXPECT_FALSE(extrinsic.find(buffer, "imu", "camera", 60.0));
  later.join();
  EXPECT_TRUE(extrinsic.pose());
}

TEST(SensorExtrinsic, AnImageDoesNotWaitWhenNewerOnesCrowd) {
  SensorExtrinsic extrinsic("IMU", "imu_rotation");
  const tf2::BufferCore empty;
  EXPECT_FALSE(extrinsic.find(empty, "imu", "camera", 600.0, [] { return true; }));
  EXPECT_FALSE(extrinsic.pose());
}

}  // namespace
}  // namespace tet_line_tracker
