#include "motion/epipolar_estimator.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/so3.h"

namespace tet_line_tracker {
namespace {

constexpr double kFocal = 458.0;

/// Points at depths of 2 to 10 m seen by a camera that moves by `step` [m, how points move] and turns by
/// `error` more than was predicted [rad], with noise of `noise_px`.
std::vector<PointPair> pairsOf(const Eigen::Vector3d& step, const Eigen::Vector3d& error, double noise_px,
                               std::vector<double>* depths = nullptr) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-0.8, 0.8);
  std::uniform_real_distribution<double> y(-0.5, 0.5);
  std::uniform_real_distribution<double> inverse(0.1, 0.5);
  std::normal_distribution<double> noise(0.0, noise_px / kFocal);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 50; ++i) {
    PointPair pair;
    pair.before = Eigen::Vector3d(x(random), y(random), 1.0);
    const double depth = 1.0 / inverse(random);
    const Eigen::Vector3d now = so3Exp(error) * (depth * pair.before) + step;
    pair.now = now / now.z() + Eigen::Vector3d(noise(random), noise(random), 0.0);
    if (depths != nullptr) depths->push_back(depth);
    pairs.push_back(pair);
  }
  return pairs;
}

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) * 180.0 / M_PI;
}

TEST(EpipolarEstimator, FindsTheDirectionWithItsSignForwardsAndSideways) {
  for (const Eigen::Vector3d& step : {Eigen::Vector3d(0.0, 0.0, -0.3), Eigen::Vector3d(0.0, 0.0, 0.3),
                                      Eigen::Vector3d(0.2, 0.0, 0.0), Eigen::Vector3d(-0.1, 0.05, -0.2)}) {
    std::vector<PointPair> pairs = pairsOf(step, Eigen::Vector3d::Zero(), 0.1);
    EpipolarEstimator estimator;
    EpipolarEstimator::Prior prior;
    prior.rotation_sigma = 0.002;
    const EgoMotion motion = estimator.estimate(pairs, kFocal, prior);
    ASSERT_TRUE(motion.known()) << step.transpose();
    EXPECT_LT(degreesBetween(motion.translation, step), 2.0) << step.transpose();
    EXPECT_EQ(motion.inliers, pairs.size());
  }
}

TEST(EpipolarEstimator, FindsTheRotationThatTheParallaxWasTakenFor) {
  // An image alignment of a sideways step turns by the mean parallax: 0.15 m at 3.3 m are 0.045 rad.
  const Eigen::Vector3d step(-0.15, 0.0, 0.0);
  const Eigen::Vector3d error(0.0, 0.04, 0.0);
  std::vector<PointPair> pairs = pairsOf(step, error, 0.1);
  EpipolarEstimator estimator;
  EpipolarEstimator::Prior prior;
  prior.rotation_sigma = 0.04;
  const EgoMotion motion = estimator.estimate(pairs, kFocal, prior);
  ASSERT_TRUE(motion.known());
  EXPECT_LT((motion.rotation - error).norm(), 0.004);
  EXPECT_LT(degreesBetween(motion.translation, step), 5.0);
}

TEST(EpipolarEstimator, IsExactWithoutNoise) {
  const Eigen::Vector3d step(0.2, 0.05, -0.1);
  const Eigen::Vector3d error(0.0, 0.002, 0.001);
  std::vector<PointPair> pairs = pairsOf(step, error, 0.0);
  EpipolarEstimator estimator;
  EpipolarEstimator::Prior prior;
  prior.rotation_sigma = 1.0;  // so wide that it does not pull
  const EgoMotion motion = estimator.estimate(pairs, kFocal, prior);
  ASSERT_TRUE(motion.known());
  EXPECT_LT((motion.translation - step.normalized()).norm(), 5e-5);
  EXPECT_LT((motion.rotation - error).norm(), 5e-6);  // small angles are taken as linear
}

TEST(EpipolarEstimator, LeavesOutAWrongPairNearTheEpipoleToo) {
  // Towards the epipole the planes of neighbouring points differ by little.
  const Eigen::Vector3d step(0.0, 0.0, -0.3);
  std::vector<PointPair> pairs = pairsOf(step, Eigen::Vector3d::Zero(), 0.1);
  PointPair wrong;
  wrong.before = Eigen::Vector3d(0.1, 0.0, 1.0);
  wrong.now = Eigen::Vector3d(0.108, 3.0 / kFocal, 1.0);
  pairs.push_back(wrong);
  EpipolarEstimator estimator;
  EpipolarEstimator::Prior prior;
  prior.rotation_sigma = 0.002;
  const EgoMotion motion = estimator.estimate(pairs, kFocal, prior);
  EXPECT_EQ(motion.inliers, pairs.size() - 1);
  EXPECT_FALSE(pairs.back().inlier);
}

TEST(EpipolarEstimator, GivesInverseDepthsInUnitsOfTheStep) {
  const Eigen::Vector3d step(0.1, 0.0, -0.3);
  std::vector<double> depths;
  std::vector<PointPair> pairs = pairsOf(step, Eigen::Vector3d::Zero(), 0.0, &depths);
  EpipolarEstimator estimator;
  ASSERT_TRUE(estimator.estimate(pairs, kFocal, {}).known());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_NEAR(pairs[i].inverse_depth, step.norm() / depths[i], 0.02 * step.norm()) << i;
  }
}

TEST(EpipolarEstimator, LeavesOutWrongPairs) {
  const Eigen::Vector3d step(0.0, 0.1, -0.3);
  std::vector<PointPair> pairs = pairsOf(step, Eigen::Vector3d::Zero(), 0.1);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-0.1, 0.1);
  for (std::size_t i = 0; i < pairs.size(); i += 3) {
    pairs[i].now += Eigen::Vector3d(anywhere(random), 0.05 + std::abs(anywhere(random)), 0.0);
  }
  EpipolarEstimator estimator;
  EpipolarEstimator::Prior prior;
  prior.rotation_sigma = 0.002;
  const EgoMotion motion = estimator.estimate(pairs, kFocal, prior);
  ASSERT_TRUE(motion.known());
  EXPECT_LT(degreesBetween(motion.translation, step), 3.0);
  for (std::size_t i = 1; i < pairs.size(); i += 3) EXPECT_TRUE(pairs[i].inlier) << i;
}

TEST(EpipolarEstimator, KnowsNoDirectionWithoutParallax) {
  std::vector<PointPair> pairs = pairsOf(Eigen::Vector3d(0.001, 0.0, 0.0), Eigen::Vector3d::Zero(), 0.1);
  EpipolarEstimator estimator;
  const EgoMotion motion = estimator.estimate(pairs, kFocal, {});
  EXPECT_FALSE(motion.known());
  EXPECT_TRUE(motion.rotates) << "the rotation is confirmed";
}

TEST(EpipolarEstimator, KnowsNothingOfPairsThatDoNotAgree) {
  std::vector<PointPair> pairs = pairsOf(Eigen::Vector3d(0.2, 0.0, 0.0), Eigen::Vector3d::Zero(), 0.1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
  for (PointPair& pair : pairs) pair.now = {anywhere(random), anywhere(random), 1.0};
  EpipolarEstimator estimator;
  const EgoMotion motion = estimator.estimate(pairs, kFocal, {});
  EXPECT_FALSE(motion.known());
  EXPECT_FALSE(motion.rotates);
}

}  // namespace
}  // namespace tet_line_tracker
