#include "tracking/detection_policy.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

DetectionParameters parameters() {
  DetectionParameters parameters;
  parameters.min_lines = 30;
  parameters.redetect_ratio = 0.9;
  parameters.detection_interval = 3;
  return parameters;
}

/// In the middle of an epoch, with every line of the last detection.
DetectionState nothingLost() {
  DetectionState state;
  state.images_in_epoch = 20;
  state.images_since_detection = 10;
  state.lines = state.lines_after_detection = 100;
  state.coverage = state.coverage_after_detection = 0.5F;
  return state;
}

TEST(MinLinesPolicy, DetectsWhenFewerThanMinLinesAreLeft) {
  const auto policy = makeMinLinesPolicy(parameters());
  DetectionState state = nothingLost();
  state.images_since_detection = 1;
  state.lines = 30;
  EXPECT_FALSE(policy->isDue(state)) << "neither the ratio nor the coverage counts";
  state.lines = 29;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, WaitsWhileNothingIsLost) {
  EXPECT_FALSE(makeReplenishPolicy(parameters())->isDue(nothingLost()));
}

TEST(ReplenishPolicy, DetectsWhenTheNumberOfLinesFallsBelowTheRatio) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.lines = 91;
  EXPECT_FALSE(policy->isDue(state));
  state.lines = 89;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, DoesNotWaitForTheIntervalWhenMostLinesAreGone) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.images_since_detection = 1;
  state.lines = 50;
  EXPECT_FALSE(policy->isDue(state));
  state.lines = 49;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, WaitsForTheIntervalWhereTheLastDetectionFoundNothing) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.images_since_detection = 1;
  state.lines = state.lines_after_detection = 0;
  EXPECT_FALSE(policy->isDue(state));
}

TEST(ReplenishPolicy, DetectsWhenTheCoverageFallsBelowTheRatio) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.coverage = 0.46F;
  EXPECT_FALSE(policy->isDue(state));
  state.coverage = 0.44F;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, DetectsWhenFewerThanMinLinesAreLeft) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.lines = state.lines_after_detection = 30;
  EXPECT_FALSE(policy->isDue(state));
  state.lines = state.lines_after_detection = 29;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, WaitsForTheDetectionIntervalWhileHalfOfTheLinesAreLeft) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.lines = 50;
  state.coverage = 0.0F;
  state.images_since_detection = 2;
  EXPECT_FALSE(policy->isDue(state));
  state.images_since_detection = 3;
  EXPECT_TRUE(policy->isDue(state));
}

TEST(ReplenishPolicy, DetectsOnTheFirstImageOfAnEpoch) {
  const auto policy = makeReplenishPolicy(parameters());
  DetectionState state = nothingLost();
  state.images_in_epoch = 1;
  state.images_since_detection = 1;
  EXPECT_TRUE(policy->isDue(state));
}

}  // namespace
}  // namespace tet_line_tracker
