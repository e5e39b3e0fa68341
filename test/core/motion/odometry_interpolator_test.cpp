#include "motion/odometry_interpolator.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kMs = 1000000;

Eigen::Isometry3d pose(double x, double y, double yaw = 0.0) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(x, y, 0.0);
  result.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return result;
}

TEST(OdometryInterpolator, TellsHowPointsMoveInTheFrameOfTheBody) {
  OdometryInterpolator odometry;
  odometry.add(1000 * kMs, pose(5.0, 7.0, 0.5 * M_PI));
  odometry.add(1100 * kMs, pose(5.0, 8.0, 0.5 * M_PI));  // a metre ahead, along y of the odometry
  const auto motion = odometry.motion(1000 * kMs, 1100 * kMs);
  ASSERT_TRUE(motion);
  EXPECT_LT((*motion * Eigen::Vector3d(3.0, 2.0, 1.0) - Eigen::Vector3d(2.0, 2.0, 1.0)).norm(), 1e-9);
}

TEST(OdometryInterpolator, BothEndsLieBetweenTwoPoses) {
  OdometryInterpolator odometry;
  for (int k = 0; k <= 4; ++k) odometry.add(k * 100 * kMs, pose(k, 0.0, 0.2 * k));
  const auto motion = odometry.motion(150 * kMs, 325 * kMs);
  ASSERT_TRUE(motion);
  const Eigen::Isometry3d expected = pose(3.25, 0.0, 0.65).inverse() * pose(1.5, 0.0, 0.3);
  EXPECT_TRUE(motion->isApprox(expected, 1e-9));
}

TEST(OdometryInterpolator, SaysNothingWhereThePosesDoNotCoverTheInterval) {
  OdometryInterpolator odometry;
  EXPECT_FALSE(odometry.motion(0, 10 * kMs));
  odometry.add(100 * kMs, pose(0.0, 0.0));
  odometry.add(200 * kMs, pose(1.0, 0.0));
  EXPECT_TRUE(odometry.motion(100 * kMs, 200 * kMs));
  EXPECT_FALSE(odometry.motion(99 * kMs, 200 * kMs));
  EXPECT_FALSE(odometry.motion(100 * kMs, 201 * kMs));
  EXPECT_FALSE(odometry.motion(150 * kMs, 150 * kMs));
  odometry.add(900 * kMs, pose(2.0, 0.0));
  EXPECT_FALSE(odometry.motion(100 * kMs, 300 * kMs)) << "a gap";
  EXPECT_FALSE(odometry.motion(150 * kMs, 900 * kMs)) << "a gap inside";
}

TEST(OdometryInterpolator, AJumpOfThePoseIsNoMotion) {
  OdometryInterpolator odometry;
  odometry.add(100 * kMs, pose(0.0, 0.0));
  odometry.add(200 * kMs, pose(500.0, 0.0));
  odometry.add(300 * kMs, pose(501.0, 0.0));
  EXPECT_FALSE(odometry.motion(100 * kMs, 200 * kMs));
  EXPECT_TRUE(odometry.motion(200 * kMs, 300 * kMs));
}

TEST(OdometryInterpolator, IgnoresWhatIsNoPoseAndWhatComesLateButNotTheNextRoundOfALoop) {
  OdometryInterpolator odometry;
  odometry.add(1000 * kMs, pose(0.0, 0.0));
  odometry.add(1050 * kMs, pose(std::numeric_limits<double>::quiet_NaN(), 0.0));
  odometry.add(1060 * kMs, pose(1e300, 0.0));
  Eigen::Isometry3d zero = pose(0.0, 0.0);
  zero.linear().setZero();
  odometry.add(1070 * kMs, zero);
  odometry.add(1100 * kMs, pose(1.0, 0.0));
  odometry.add(1090 * kMs, pose(70.0, 0.0));  // late
  const auto motion = odometry.motion(1000 * kMs, 1100 * kMs);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation().x(), -1.0, 1e-9);

  odometry.add(100 * kMs, pose(0.0, 0.0));
  odometry.add(200 * kMs, pose(0.0, 3.0));
  const auto again = odometry.motion(100 * kMs, 200 * kMs);
  ASSERT_TRUE(again);
  EXPECT_NEAR(again->translation().y(), -3.0, 1e-9);
  EXPECT_FALSE(odometry.motion(1000 * kMs, 1100 * kMs));
}

TEST(OdometryInterpolator, ForgetsOnlyWhatNoLaterImageNeeds) {
  OdometryInterpolator odometry;
  for (int k = 0; k <= 10; ++k) odometry.add(k * 100 * kMs, pose(k, 0.0));
  odometry.forgetBefore(550 * kMs);
  EXPECT_TRUE(odometry.motion(550 * kMs, 950 * kMs));
  EXPECT_FALSE(odometry.motion(450 * kMs, 950 * kMs));
}

}  // namespace
}  // namespace tet_line_tracker
