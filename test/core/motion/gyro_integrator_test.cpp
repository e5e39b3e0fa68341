#include "motion/gyro_integrator.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/so3.h"

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kMs = 1000000;

/// Samples every 5 ms from `first_ms` to `last_ms` of a velocity that depends on the time [s].
template <class Velocity>
void addSamples(GyroIntegrator& gyro, std::int64_t first_ms, std::int64_t last_ms, const Velocity& velocity) {
  for (std::int64_t t = first_ms; t <= last_ms; t += 5)
    gyro.add(t * kMs, velocity(1e-3 * static_cast<double>(t)));
}

/// What directions do when the frame itself turns by `turn` [rad].
Eigen::Matrix3d directionsAfter(const Eigen::Vector3d& turn) {
  return so3Exp(-turn).toRotationMatrix();
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

const Eigen::Vector3d kNoBias = Eigen::Vector3d::Zero();

TEST(GyroIntegrator, AConstantRateIsExactBetweenAnyTwoStamps) {
  const Eigen::Vector3d velocity(0.3, -1.1, 2.0);
  GyroIntegrator gyro;
  addSamples(gyro, 0, 200, [&](double) { return velocity; });
  for (const auto& [from, to] : {std::pair{0L, 200L}, {3L, 51L}, {11L, 12L}, {10L, 60L}}) {
    const auto rotation = gyro.rotation(from * kMs, to * kMs, kNoBias);
    ASSERT_TRUE(rotation) << from << " to " << to;
    const Eigen::Vector3d turn = velocity * (1e-3 * static_cast<double>(to - from));
    EXPECT_LT(angleBetween(*rotation, directionsAfter(turn)), 1e-7);
  }
}

TEST(GyroIntegrator, ADirectionThatStaysInTheWorldMovesAgainstTheTurn) {
  GyroIntegrator gyro;
  addSamples(gyro, 0, 1000, [](double) { return Eigen::Vector3d(0.0, 0.0, 0.5 * M_PI); });
  // A quarter turn to the left in one second: what was ahead is then on the right.
  const auto rotation = gyro.rotation(0, 1000 * kMs, kNoBias);
  ASSERT_TRUE(rotation);
  EXPECT_LT((*rotation * Eigen::Vector3d::UnitX() - -Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(GyroIntegrator, ALinearRateIsInterpolatedAtBothEnds) {
  // 10 rad/s^2: between two samples the rate changes by 0.05 rad/s, which the nearest sample would miss.
  GyroIntegrator gyro;
  addSamples(gyro, 0, 200, [](double t) { return Eigen::Vector3d(0.0, 10.0 * t, 0.0); });
  const auto rotation = gyro.rotation(12 * kMs, 73 * kMs, kNoBias);
  ASSERT_TRUE(rotation);
  const double angle = 5.0 * (0.073 * 0.073 - 0.012 * 0.012);
  EXPECT_LT(angleBetween(*rotation, directionsAfter({0.0, angle, 0.0})), 1e-7);
}

TEST(GyroIntegrator, TheBiasIsTakenOff) {
  const Eigen::Vector3d velocity(0.3, -1.1, 2.0);
  const Eigen::Vector3d bias(-0.02, 0.08, 0.05);
  GyroIntegrator gyro;
  addSamples(gyro, 0, 100, [&](double) { return velocity + bias; });
  const auto rotation = gyro.rotation(0, 100 * kMs, bias);
  ASSERT_TRUE(rotation);
  EXPECT_LT(angleBetween(*rotation, directionsAfter(0.1 * velocity)), 1e-7);
}

TEST(GyroIntegrator, NothingIsSaidAboutTimesThatTheSamplesDoNotCover) {
  GyroIntegrator gyro;
  EXPECT_FALSE(gyro.rotation(0, kMs, kNoBias));
  addSamples(gyro, 10, 100, [](double) { return Eigen::Vector3d::UnitX(); });
  EXPECT_FALSE(gyro.rotation(9 * kMs, 50 * kMs, kNoBias));
  EXPECT_FALSE(gyro.rotation(50 * kMs, 101 * kMs, kNoBias));
  EXPECT_FALSE(gyro.rotation(50 * kMs, 50 * kMs, kNoBias));
  EXPECT_FALSE(gyro.rotation(60 * kMs, 50 * kMs, kNoBias));
  EXPECT_TRUE(gyro.rotation(10 * kMs, 100 * kMs, kNoBias));
}

TEST(GyroIntegrator, NothingIsSaidAcrossAGap) {
  GyroIntegrator gyro;
  const auto constant = [](double) { return Eigen::Vector3d::UnitX(); };
  addSamples(gyro, 0, 100, constant);
  addSamples(gyro, 250, 400, constant);
  EXPECT_FALSE(gyro.rotation(50 * kMs, 300 * kMs, kNoBias));
  EXPECT_FALSE(gyro.rotation(120 * kMs, 200 * kMs, kNoBias));
  EXPECT_TRUE(gyro.rotation(0, 100 * kMs, kNoBias));
  EXPECT_TRUE(gyro.rotation(250 * kMs, 400 * kMs, kNoBias));
}

TEST(GyroIntegrator, AJumpBackBeginsAnewAndALateSampleIsIgnored) {
  GyroIntegrator gyro;
  const Eigen::Vector3d first(1.0, 0.0, 0.0);
  const Eigen::Vector3d second(0.0, 2.0, 0.0);
  addSamples(gyro, 5000, 5100, [&](double) { return first; });
  gyro.add(5097 * kMs, second);  // late
  gyro.add(5100 * kMs, second);  // twice
  auto rotation = gyro.rotation(5000 * kMs, 5100 * kMs, kNoBias);
  ASSERT_TRUE(rotation);
  EXPECT_LT(angleBetween(*rotation, directionsAfter(0.1 * first)), 1e-7);

  addSamples(gyro, 0, 100, [&](double) { return second; });
  EXPECT_FALSE(gyro.rotation(5000 * kMs, 5100 * kMs, kNoBias));
  rotation = gyro.rotation(0, 100 * kMs, kNoBias);
  ASSERT_TRUE(rotation);
  EXPECT_LT(angleBetween(*rotation, directionsAfter(0.1 * second)), 1e-7);
}

TEST(GyroIntegrator, SamplesThatNoGyroscopeMeasuresAreIgnored) {
  GyroIntegrator gyro;
  gyro.add(0, Eigen::Vector3d::UnitX());
  gyro.add(2 * kMs, Eigen::Vector3d(1e300, 0.0, 0.0));
  gyro.add(3 * kMs, Eigen::Vector3d(1e160, 1e160, 1e160));
  gyro.add(4 * kMs, Eigen::Vector3d(0.0, -1001.0, 0.0));
  gyro.add(5 * kMs, Eigen::Vector3d(NAN, 0.0, 0.0));
  gyro.add(6 * kMs, Eigen::Vector3d(0.0, INFINITY, 0.0));
  gyro.add(10 * kMs, Eigen::Vector3d::UnitX());
  const auto rotation = gyro.rotation(0, 10 * kMs, kNoBias);
  ASSERT_TRUE(rotation);
  EXPECT_LT(angleBetween(*rotation, directionsAfter({0.01, 0.0, 0.0})), 1e-7);
}

TEST(GyroIntegrator, ForgettingKeepsWhatTheNextIntervalNeeds) {
  GyroIntegrator gyro;
  addSamples(gyro, 0, 100, [](double) { return Eigen::Vector3d::UnitX(); });
  gyro.forgetBefore(52 * kMs);
  EXPECT_FALSE(gyro.rotation(40 * kMs, 90 * kMs, kNoBias));
  EXPECT_TRUE(gyro.rotation(52 * kMs, 90 * kMs, kNoBias));
}

}  // namespace
}  // namespace tet_line_tracker
