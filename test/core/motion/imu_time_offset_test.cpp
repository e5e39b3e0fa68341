#include "motion/imu_time_offset.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kMs = 1000000;

/// Angular velocity of a hand-held camera in the IMU's frame [rad/s].
Eigen::Vector3d velocityAt(double time_s) {
  return {0.40 * std::sin(13.2 * time_s), 0.35 * std::sin(9.1 * time_s + 1.0), 0.3 * std::cos(6.0 * time_s)};
}

/// Its integral since time 0 [rad].
Eigen::Vector3d angleAt(double time_s) {
  return {-0.40 / 13.2 * (std::cos(13.2 * time_s) - 1.0),
          -0.35 / 9.1 * (std::cos(9.1 * time_s + 1.0) - std::cos(1.0)), 0.3 / 6.0 * std::sin(6.0 * time_s)};
}

const Eigen::Matrix3d kCameraFromImu =
    Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();

struct Flight {
  double offset_s{0.0};
  double scale{1.0};      ///< of all turns
  double noise{1e-3};     ///< of the images' rotations [rad]
  double wrong_share{0};  ///< of images whose rotation is anything
  double seconds{20.0};
  Eigen::Vector3d bias{0.05, -0.1, 0.02};  ///< of the gyroscope [rad/s]
};

/// An IMU at 200 Hz and images at 20 Hz, in the order in which a node gets them.
ImuTimeOffset fly(const Flight& flight, ImuTimeOffset offset = ImuTimeOffset(), double start_s = 0.0) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < static_cast<int>(200.0 * flight.seconds); ++i) {
    const double time_s = start_s + 0.005 * i;
    offset.addAngularVelocity(std::llround(1e9 * (100.0 + time_s + flight.offset_s)),
                              flight.scale * velocityAt(time_s) + flight.bias);
    if (i == 0 || i % 10 != 0) continue;
    Eigen::Vector3d seen = -(kCameraFromImu * (flight.scale * (angleAt(time_s) - angleAt(time_s - 0.05))));
    seen += flight.noise * Eigen::Vector3d(normal(random), normal(random), normal(random));
    if (uniform(random) < flight.wrong_share)
      seen = 0.05 * Eigen::Vector3d(normal(random), normal(random), 0.0);
    offset.addImageRotation(std::llround(1e9 * (100.0 + time_s - 0.05)), std::llround(1e9 * (100.0 + time_s)),
                            seen, kCameraFromImu);
  }
  return offset;
}

TEST(ImuTimeOffset, IsFoundToHalfAMillisecondWhateverItsSignAndTheBias) {
  for (const double offset_s : {-0.085, -0.0213, 0.0, 0.004, 0.02, 0.0707}) {
    Flight flight;
    flight.offset_s = offset_s;
    const ImuTimeOffset found = fly(flight);
    EXPECT_NEAR(found.value(), offset_s, 7e-4);
    ASSERT_TRUE(found.sigma());
    EXPECT_LT(*found.sigma(), 5e-4);
  }
}

TEST(ImuTimeOffset, IsFoundThoughOneImageInFiveSeesAnything) {
  Flight flight;
  flight.offset_s = 0.03;
  flight.wrong_share = 0.2;
  EXPECT_NEAR(fly(flight).value(), 0.03, 1e-3);
}

TEST(ImuTimeOffset, StaysWhereItIsWithoutTurns) {
  Flight flight;
  flight.offset_s = 0.03;
  flight.scale = 0.0;
  EXPECT_EQ(fly(flight).value(), 0.0);
  // Known once, it is kept while the camera stands.
  Flight turning;
  turning.offset_s = 0.03;
  const ImuTimeOffset known = fly(turning);
  Flight standing = flight;
  standing.seconds = 10.0;
  EXPECT_NEAR(fly(standing, known, turning.seconds).value(), known.value(), 1e-3);
}

TEST(ImuTimeOffset, BeyondATenthOfASecondIsNotTakenForAnotherOne) {
  Flight flight;
  flight.offset_s = 0.25;
  EXPECT_EQ(fly(flight).value(), 0.0);
}

TEST(ImuTimeOffset, FollowsAClockThatIsSetAnew) {
  Flight before;
  before.offset_s = 0.01;
  Flight after = before;
  after.offset_s = 0.03;
  after.seconds = 120.0;
  EXPECT_NEAR(fly(after, fly(before), before.seconds).value(), 0.03, 1e-3);
}

TEST(ImuTimeOffset, IgnoresWhatIsNotFiniteAndIntervalsWithAGap) {
  Flight flight;
  flight.offset_s = 0.02;
  ImuTimeOffset offset = fly(flight);
  const double before = offset.value();
  const double nan = std::nan("");
  const auto stamp = [](double s) { return std::llround(1e9 * (100.0 + s)); };
  offset.addImageRotation(stamp(20.0), stamp(20.05), {nan, 0.0, 0.0}, kCameraFromImu);
  offset.addAngularVelocity(stamp(20.1), {0.0, nan, 0.0});
  // Half a second without samples, in which the camera is said to have turned.
  offset.addImageRotation(stamp(20.2), stamp(20.25), {0.3, 0.2, 0.1}, kCameraFromImu);
  offset.addAngularVelocity(stamp(20.6), {0.0, 0.0, 0.0});
  offset.addAngularVelocity(stamp(20.6) + 5 * kMs, {0.0, 0.0, 0.0});
  EXPECT_EQ(offset.value(), before);
  offset.reset();
  EXPECT_EQ(offset.value(), 0.0);
  EXPECT_FALSE(offset.sigma());
}

}  // namespace
}  // namespace tet_line_tracker
