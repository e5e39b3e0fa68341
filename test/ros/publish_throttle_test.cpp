#include "publish_throttle.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kStart = 1403715273262142976;

/// Images of `images_hz` over `seconds` that pass a throttle of `rate_hz`. Every second stamp is late by
/// `jitter_ns`.
int passed(double rate_hz, double images_hz, double seconds, std::int64_t jitter_ns = 0) {
  PublishThrottle throttle(rate_hz);
  int count = 0;
  for (int i = 0; i < static_cast<int>(seconds * images_hz); ++i) {
    count += static_cast<int>(
        throttle.pass(kStart + static_cast<std::int64_t>(1e9 * i / images_hz) + (i % 2) * jitter_ns));
  }
  return count;
}

TEST(PublishThrottle, LetsEveryImagePassAtRateZero) {
  EXPECT_EQ(passed(0.0, 20.0, 10.0), 200);
}

TEST(PublishThrottle, KeepsTheRateOnTheAverage) {
  EXPECT_EQ(passed(10.0, 20.0, 10.0), 100);
  EXPECT_NEAR(passed(20.0, 30.0, 10.0), 200, 2);
  EXPECT_NEAR(passed(7.0, 20.0, 10.0), 70, 2);
  EXPECT_NEAR(passed(10.0, 200.0, 10.0), 100, 1);
}

TEST(PublishThrottle, LeavesNoImageOutWhenTheCameraIsSlowerOrSlightlyOffTheRate) {
  EXPECT_EQ(passed(20.0, 10.0, 10.0), 100);
  EXPECT_EQ(passed(20.0, 20.0, 10.0, 4'000'000), 200);
  EXPECT_EQ(passed(20.0, 21.0, 10.0), 210);
}

TEST(PublishThrottle, StartsAnewWhenTheStampsJumpBack) {
  PublishThrottle throttle(1.0);
  EXPECT_TRUE(throttle.pass(kStart));
  EXPECT_FALSE(throttle.pass(kStart + 500'000'000));
  EXPECT_TRUE(throttle.pass(kStart - 10'000'000'000));
  EXPECT_FALSE(throttle.pass(kStart - 9'500'000'000));
}

TEST(PublishThrottle, DoesNotCatchUpAfterAGap) {
  PublishThrottle throttle(10.0);
  EXPECT_TRUE(throttle.pass(kStart));
  EXPECT_TRUE(throttle.pass(kStart + 5'050'000'000));
  EXPECT_FALSE(throttle.pass(kStart + 5'100'000'000));
}

TEST(PublishThrottle, LetsTheNextImagePassAfterAReset) {
  PublishThrottle throttle(1.0);
  EXPECT_TRUE(throttle.pass(kStart));
  throttle.reset();
  EXPECT_TRUE(throttle.pass(kStart + 1'000'000));
}

TEST(PublishThrottle, RefusesANegativeRate) {
  EXPECT_THROW(PublishThrottle(-1.0), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker
