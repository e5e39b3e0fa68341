#include "motion/gyro_bias.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

const Eigen::Vector3f kBias(0.12F, -0.16F, 0.02F);  // 0.2 rad/s in all

/// Learns from `seconds` of images at `rate_hz`, whose rotations are wrong by
/// up to `noise_rad`.
void learn(GyroBias& bias, const Eigen::Vector3f& truth, float rate_hz, float seconds,
           float noise_rad = 0.0F) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(-noise_rad, noise_rad);
  const float interval = 1.0F / rate_hz;
  for (float t = 0.0F; t < seconds; t += interval) {
    const Eigen::Vector3f seen = interval * Eigen::Vector3f(0.5F, 1.0F, -0.3F);
    const Eigen::Vector3f error(noise(random), noise(random), noise(random));
    bias.learn(seen + interval * truth, seen + error, interval);
  }
}

TEST(GyroBias, ABiasOfAFifthOfARadianPerSecondIsKnownAfterTenImages) {
  for (const float rate : {20.0F, 200.0F}) {
    GyroBias bias;
    learn(bias, kBias, rate, 9.5F / rate);
    EXPECT_LT((bias.value() - kBias).norm(), 0.01F) << rate << " Hz";
  }
}

TEST(GyroBias, TheTimeToFollowAChangeIsInSecondsAndNotInImages) {
  for (const float rate : {20.0F, 200.0F}) {
    GyroBias bias;
    learn(bias, Eigen::Vector3f::Zero(), rate, 2.0F * GyroBias::kTimeConstant);
    const Eigen::Vector3f small = 0.25F * kBias;
    learn(bias, small, rate, GyroBias::kTimeConstant);
    // 1 - 1/e of the way.
    EXPECT_NEAR(bias.value().norm() / small.norm(), 0.632F, 0.02F) << rate << " Hz";
  }
}

TEST(GyroBias, NoiseOfTheImagesIsAveraged) {
  GyroBias bias;
  learn(bias, kBias, 200.0F, 5.0F, 3e-4F);  // 0.06 rad/s from image to image
  EXPECT_LT((bias.value() - kBias).norm(), 0.01F);
}

TEST(GyroBias, AnImageThatSeesAnotherRotationHardlyMovesIt) {
  GyroBias bias;
  learn(bias, kBias, 20.0F, 5.0F);
  const Eigen::Vector3f before = bias.value();
  // Something large crosses the view: 0.5 rad/s for a second moves the bias as
  // 0.1 rad/s would.
  for (int i = 0; i < 20; ++i) bias.learn(0.05F * (kBias + Eigen::Vector3f(0.5F, 0, 0)), {0, 0, 0}, 0.05F);
  EXPECT_LT((bias.value() - before).norm(), 0.021F);
  EXPECT_GT((bias.value() - before).norm(), 0.01F);
  // A wrong rotation does not at all.
  const Eigen::Vector3f now = bias.value();
  bias.learn(0.05F * kBias, Eigen::Vector3f(0.5F, 0.0F, 0.0F), 0.05F);
  EXPECT_EQ(bias.value(), now);
}

TEST(GyroBias, WhatIsNotFiniteIsIgnored) {
  GyroBias bias;
  learn(bias, kBias, 20.0F, 1.0F);
  const Eigen::Vector3f before = bias.value();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bias.learn({nan, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 0.05F);
  bias.learn({0.0F, 0.0F, 0.0F}, {0.0F, std::numeric_limits<float>::infinity(), 0.0F}, 0.05F);
  bias.learn({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 0.0F);
  EXPECT_EQ(bias.value(), before);
  bias.reset();
  EXPECT_EQ(bias.value(), Eigen::Vector3f(0.0F, 0.0F, 0.0F));
}

TEST(GyroBias, IsTrustedOnceImagesHaveAgreedForHalfASecond) {
  GyroBias bias;
  EXPECT_FALSE(bias.isTrusted());
  learn(bias, 0.1F * kBias, 20.0F, 0.4F);
  EXPECT_FALSE(bias.isTrusted());
  learn(bias, 0.1F * kBias, 20.0F, 1.0F);
  EXPECT_TRUE(bias.isTrusted());
}

TEST(GyroBias, IsNoLongerTrustedWhenTheImagesContradictIt) {
  GyroBias bias;
  learn(bias, 0.1F * kBias, 20.0F, 2.0F);
  ASSERT_TRUE(bias.isTrusted());
  // As of a gyroscope that stopped: 0.5 rad/s off.
  for (int i = 0; i < 4; ++i) bias.learn({0.0F, 0.0F, 0.0F}, {0.025F, 0.0F, 0.0F}, 0.05F);
  EXPECT_FALSE(bias.isTrusted());
}

TEST(GyroBias, IsNoLongerTrustedAfterEightImagesInARowThatShowNothing) {
  GyroBias bias;
  learn(bias, Eigen::Vector3f::Zero(), 20.0F, 2.0F);
  for (int i = 0; i < 7; ++i) bias.doubt();
  EXPECT_TRUE(bias.isTrusted());
  bias.doubt();
  EXPECT_FALSE(bias.isTrusted());
  learn(bias, Eigen::Vector3f::Zero(), 20.0F, 0.5F);
  EXPECT_TRUE(bias.isTrusted()) << "and it is again when they agree";
}

TEST(GyroBias, ItsDeviationShrinksWhileItIsLearned) {
  GyroBias bias;
  EXPECT_FLOAT_EQ(bias.deviation(), 0.1F);
  learn(bias, kBias, 20.0F, 0.5F);
  EXPECT_NEAR(bias.deviation(), 0.1F / 6.0F, 0.002F);
  learn(bias, kBias, 20.0F, 5.0F);
  EXPECT_FLOAT_EQ(bias.deviation(), 0.01F);
}

}  // namespace
}  // namespace tet_line_tracker
