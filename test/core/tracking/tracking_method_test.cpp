#include "tracking/tracking_method.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

std::vector<LossReason> reasonsOf(const LineTrackerParameters& parameters) {
  std::vector<LossReason> reasons;
  for (const auto& check : makeTrackingMethod(parameters).checks) reasons.push_back(check->reason());
  return reasons;
}

LineTrackerParameters named(const char* method) {
  LineTrackerParameters parameters;
  parameters.method = method;
  return parameters;
}

TEST(TrackingMethod, JointAppliesEveryCheckInTheOrderOfTheLossReasons) {
  const std::vector<LossReason> expected{
      LossReason::kLengthRatio, LossReason::kAngle,       LossReason::kSupport, LossReason::kBorder,
      LossReason::kShort,       LossReason::kFieldOfView, LossReason::kMask,    LossReason::kDepth,
      LossReason::kEdgeJump,    LossReason::kDuplicate};
  EXPECT_EQ(reasonsOf(named("joint")), expected);
}

TEST(TrackingMethod, JointWithoutTheRefitHasNoChecksOfTheEdge) {
  LineTrackerParameters parameters = named("joint");
  parameters.refiner.refine = false;
  EXPECT_EQ(makeTrackingMethod(parameters).refiner, nullptr);
  EXPECT_FALSE(makeTrackingMethod(parameters).grower);
  for (const LossReason reason : reasonsOf(parameters)) {
    EXPECT_NE(reason, LossReason::kSupport);
    EXPECT_NE(reason, LossReason::kEdgeJump);
  }
}

TEST(TrackingMethod, PaperKnowsNeitherMotionPriorNorRefitNorPlausibility) {
  const TrackingMethod method = makeTrackingMethod(named("paper"));
  EXPECT_EQ(method.motion.prior, "none");
  EXPECT_FALSE(method.motion.predict_parallax);
  EXPECT_EQ(method.refiner, nullptr);
  EXPECT_FALSE(method.grower);
  EXPECT_EQ(method.dead_band_px, 0.0F);
  const std::vector<LossReason> expected{LossReason::kBorder, LossReason::kShort, LossReason::kFieldOfView,
                                         LossReason::kMask};
  EXPECT_EQ(reasonsOf(named("paper")), expected);
}

TEST(TrackingMethod, AnUnknownMethodIsRefused) {
  EXPECT_THROW(makeTrackingMethod(named("best")), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker
