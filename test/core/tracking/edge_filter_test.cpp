#include "tracking/edge_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tet_line_tracker {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const LineSegment kTrue{{100.0F, 50.0F}, {180.0F, 90.0F}};

LineSegment movedAcross(const LineSegment& line, float start, float end) {
  const Eigen::Vector2f normal = line.normal();
  return {line.start + start * normal, line.end + end * normal};
}

/// A fit that is off by these distances and says that its deviation is `sigma` at both ends, which err
/// independently, of which the share `noise` of the variance is new in each image.
EdgeFit fitOf(float start, float end, float sigma, float noise = 1.0F) {
  EdgeFit fit;
  fit.segment = movedAcross(kTrue, start, end);
  fit.support = 0.9F;
  fit.contrast = 3.0F;
  const float variance = sigma * sigma;
  fit.covariance_px = {variance, 0.0F, variance};
  fit.noise_px = {noise * variance, 0.0F, noise * variance};
  fit.sigma_px = std::sqrt(0.5F * variance);
  return fit;
}

EdgePrediction predictionOf(float start, float end, float sigma, float flow_sigma) {
  return {movedAcross(kTrue, start, end), {sigma * sigma, 0.0F, sigma * sigma}, flow_sigma};
}

float errorOf(const LineSegment& line) {
  return kTrue.distance(line.start);
}

/// Root mean square of errors, and of errors over what the filter claims, while flow and fits of a line err
/// by these deviations.
struct Outcome {
  double error{0.0};
  double normalized{0.0};
};
Outcome filter(float fit_sigma, float flow_sigma, int images) {
  std::mt19937 random(1);
  std::normal_distribution<float> gauss;
  EdgeFit line = fitOf(fit_sigma * gauss(random), fit_sigma * gauss(random), fit_sigma);
  Outcome outcome;
  for (int i = 0; i < images; ++i) {
    const LineSegment followed =
        movedAcross(line.segment, flow_sigma * gauss(random), flow_sigma * gauss(random));
    const EdgeFit measured = fitOf(fit_sigma * gauss(random), fit_sigma * gauss(random), fit_sigma);
    line = updateEdge({followed, line.noise_px, flow_sigma}, measured);
    const double error = static_cast<double>(errorOf(line.segment));
    outcome.error += error * error / images;
    outcome.normalized += error * error / static_cast<double>(line.covariance_px[0]) / images;
  }
  return {std::sqrt(outcome.error), std::sqrt(outcome.normalized)};
}

TEST(EdgeFilter, AFaintEdgeThatIsFollowedWellIsKnownBetterThanItIsMeasured) {
  const Outcome outcome = filter(0.2F, 0.1F, 2000);
  // A Kalman filter in its steady state: 0.125 px.
  EXPECT_NEAR(outcome.error, 0.125, 0.01);
  EXPECT_NEAR(outcome.normalized, 1.0, 0.08);
}

TEST(EdgeFilter, AClearEdgeIsWhereItIsMeasured) {
  const EdgeFit updated = updateEdge(predictionOf(0.1F, -0.1F, 0.02F, 0.15F), fitOf(0.0F, 0.0F, 0.02F));
  EXPECT_NEAR(errorOf(updated.segment), 0.0F, 0.002F);
}

TEST(EdgeFilter, BothEndsMoveEachToItsOwnSide) {
  const EdgeFit updated = updateEdge(predictionOf(0.3F, -0.2F, 0.2F, 0.0F), fitOf(0.1F, 0.2F, 0.2F));
  EXPECT_NEAR(kTrue.distance(updated.segment.start), 0.2F, 1e-3F);
  EXPECT_NEAR(kTrue.distance(updated.segment.end), 0.0F, 1e-3F);
}

TEST(EdgeFilter, EndsThatErrAlikeTellOfEachOther) {
  // What was known of both ends was that they are off by the same.
  EdgePrediction predicted = predictionOf(0.2F, 0.2F, 0.2F, 0.0F);
  predicted.noise_px[1] = 0.99F * predicted.noise_px[0];
  EdgeFit measured = fitOf(0.0F, 0.0F, 0.02F);
  measured.noise_px[2] = measured.covariance_px[2] = 100.0F;  // of the end, nothing is seen
  const EdgeFit updated = updateEdge(predicted, measured);
  EXPECT_NEAR(kTrue.distance(updated.segment.start), 0.0F, 0.01F);
  EXPECT_NEAR(kTrue.distance(updated.segment.end), 0.0F, 0.01F);
  EXPECT_GT(updated.noise_px[1], 0.0F);
}

TEST(EdgeFilter, WhatIsCommonToBothEndsIsWeighedOnce) {
  EdgePrediction predicted = predictionOf(0.2F, 0.2F, 0.2F, 0.0F);
  predicted.noise_px[1] = predicted.noise_px[0];
  const EdgeFit updated = updateEdge(predicted, fitOf(0.0F, 0.0F, 0.2F));
  // Variances of the common distance: 0.04 px^2, of the mean of two measured ends 0.02.
  EXPECT_NEAR(kTrue.distance(updated.segment.start), 0.2F / 3.0F, 1e-3F);
  EXPECT_NEAR(kTrue.distance(updated.segment.end), 0.2F / 3.0F, 1e-3F);
}

TEST(EdgeFilter, MovementThatTheFlowHasNotSeenIsBelievedAtOnce) {
  const EdgeFit updated = updateEdge(predictionOf(2.0F, 2.0F, 0.05F, 0.05F), fitOf(0.0F, 0.0F, 0.2F));
  EXPECT_LT(std::abs(errorOf(updated.segment)), 0.03F);
  EXPECT_LT(std::abs(kTrue.distance(updated.segment.end)), 0.03F);
}

TEST(EdgeFilter, WhatErrsAlikeInAllImagesIsNotAveraged) {
  EdgeFit line = fitOf(0.0F, 0.0F, 0.2F, 0.6F);
  for (int i = 0; i < 500; ++i) {
    line = updateEdge({line.segment, line.noise_px, 0.0F}, fitOf(0.0F, 0.0F, 0.2F, 0.6F));
  }
  EXPECT_NEAR(line.covariance_px[0], 0.4F * 0.04F, 0.001F);
  EXPECT_NEAR(line.covariance_px[2], 0.4F * 0.04F, 0.001F);
  EXPECT_NEAR(line.sigma_px, std::sqrt(0.5F * 0.4F) * 0.2F, 0.002F);
}

TEST(EdgeFilter, WhatIsNotKnownLeavesTheFitAsItIs) {
  const EdgeFit measured = fitOf(0.1F, 0.2F, 0.2F);
  EdgePrediction predicted = predictionOf(0.5F, 0.5F, 0.1F, 0.1F);
  predicted.noise_px = {kNaN, kNaN, kNaN};
  EXPECT_EQ(updateEdge(predicted, measured).segment.start, measured.segment.start);
  EdgeFit unknown = measured;
  unknown.noise_px = {kNaN, kNaN, kNaN};
  const EdgeFit updated = updateEdge(predictionOf(0.5F, 0.5F, 0.1F, 0.1F), unknown);
  EXPECT_EQ(updated.segment.start, measured.segment.start);
  EXPECT_EQ(updated.segment.end, measured.segment.end);
  EXPECT_EQ(updated.sigma_px, measured.sigma_px);
  EXPECT_EQ(updated.support, measured.support);
}

TEST(EdgeFilter, TwoThatAreSurePassOn) {
  const EdgeFit updated = updateEdge(predictionOf(0.0F, 0.0F, 0.0F, 0.0F), fitOf(0.0F, 0.0F, 0.0F));
  EXPECT_TRUE(updated.segment.start.allFinite());
  EXPECT_EQ(updated.sigma_px, 0.0F);
}

}  // namespace
}  // namespace tet_line_tracker
