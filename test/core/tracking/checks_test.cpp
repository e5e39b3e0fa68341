#include "tracking/checks.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {
namespace {

const LineSegment kHorizontal{{100.0F, 200.0F}, {200.0F, 200.0F}};

LineSegment ofLength(float length) {
  return {kHorizontal.start, kHorizontal.start + Eigen::Vector2f(length, 0.0F)};
}

LineSegment atAngle(float angle) {
  return {kHorizontal.start, kHorizontal.start + 100.0F * Eigen::Vector2f(std::cos(angle), std::sin(angle))};
}

/// Tracks in an image of 640 x 400 px with a border of 2 px.
class Checks : public testing::Test {
 protected:
  Checks() { area_.setImageSize({640, 400}); }

  /// A track found where it was predicted, on an edge from end to end.
  TrackState& add(const LineSegment& line) {
    EdgeFit edge;
    edge.segment = line;
    edge.contrast = 20.0F;
    tracks_.add(edge, LineBend{});
    TrackState& state = tracks_.state(tracks_.size() - 1);
    state.predicted = state.followed = line;
    return state;
  }

  /// Whether a track that the flow took from `predicted` to `followed` passes.
  bool passes(TrackCheck& check, const LineSegment& predicted, const LineSegment& followed) {
    tracks_.clear();
    add(followed).predicted = predicted;
    check.apply(area_, tracks_, statistics_);
    return isKept(check);
  }
  bool passes(TrackCheck& check, const LineSegment& line) { return passes(check, line, line); }

  /// That the only track is kept, or lost for the reason of the check.
  bool isKept(const TrackCheck& check) {
    const bool kept = !tracks_.state(0).lost();
    EXPECT_EQ(tracks_.state(0).loss, kept ? LossReason::kCount : check.reason());
    return kept;
  }

  VisibleArea area_{2.0};
  TrackTable tracks_;
  FrameStatistics statistics_;
};

TEST_F(Checks, DepthCheckLosesTheFewWhoseMovementContradictsTheirDepth) {
  DepthCheck check;
  EXPECT_EQ(check.reason(), LossReason::kDepth);
  for (int i = 0; i < 10; ++i) add(kHorizontal).depth_conflict = i == 3 || i == 7;
  statistics_.translation_inliers = DepthCheck::kMinInliers;
  check.apply(area_, tracks_, statistics_);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(tracks_.state(i).loss, i == 3 || i == 7 ? LossReason::kDepth : LossReason::kCount) << i;
  }
}

TEST_F(Checks, DepthCheckLosesNoneWhenManyContradictSinceTheMotionMayBeWrong) {
  DepthCheck check;
  for (int i = 0; i < 10; ++i) add(kHorizontal).depth_conflict = i < 3;
  statistics_.translation_inliers = DepthCheck::kMinInliers;
  check.apply(area_, tracks_, statistics_);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_FALSE(tracks_.state(i).lost()) << i;
}

TEST_F(Checks, DepthCheckLosesNoneWhereFewCornersTellTheMotion) {
  DepthCheck check;
  for (int i = 0; i < 10; ++i) add(kHorizontal).depth_conflict = i == 3;
  statistics_.translation_inliers = DepthCheck::kMinInliers - 1;
  check.apply(area_, tracks_, statistics_);
  EXPECT_FALSE(tracks_.state(3).lost());
}

TEST_F(Checks, ALineMustNotBecomeLongerOrShorterThanMaxLengthRatio) {
  LengthRatioCheck check(1.5);
  EXPECT_EQ(check.reason(), LossReason::kLengthRatio);
  EXPECT_TRUE(passes(check, kHorizontal, ofLength(148.0F)));
  EXPECT_FALSE(passes(check, kHorizontal, ofLength(152.0F)));
  EXPECT_TRUE(passes(check, kHorizontal, ofLength(68.0F)));
  EXPECT_FALSE(passes(check, kHorizontal, ofLength(65.0F)));
}

TEST_F(Checks, ALineMustNotTurnByMoreThanMaxRotation) {
  AngleCheck check(0.2);
  EXPECT_EQ(check.reason(), LossReason::kAngle);
  EXPECT_TRUE(passes(check, kHorizontal, atAngle(0.19F)));
  EXPECT_TRUE(passes(check, kHorizontal, atAngle(-0.19F)));
  EXPECT_FALSE(passes(check, kHorizontal, atAngle(0.21F)));
  EXPECT_FALSE(passes(check, kHorizontal, atAngle(-0.21F)));
  EXPECT_FALSE(passes(check, kHorizontal, {kHorizontal.end, kHorizontal.start}));
}

TEST_F(Checks, AnEdgeMustLieUnderTheLineOverMinSupportOfIt) {
  SupportCheck check(0.5);
  EXPECT_EQ(check.reason(), LossReason::kSupport);
  add(kHorizontal).support = 0.51F;
  add(kHorizontal).support = 0.49F;
  check.apply(area_, tracks_, statistics_);
  EXPECT_FALSE(tracks_.state(0).lost());
  EXPECT_EQ(tracks_.state(1).loss, LossReason::kSupport);
}

TEST_F(Checks, NeitherEndpointMayLeaveTheImage) {
  EndpointsInImageCheck check;
  EXPECT_EQ(check.reason(), LossReason::kBorder);
  EXPECT_TRUE(passes(check, {{2.0F, 2.0F}, {637.0F, 397.0F}}));
  EXPECT_FALSE(passes(check, {{1.5F, 200.0F}, {100.0F, 200.0F}}));
  EXPECT_FALSE(passes(check, {{100.0F, 200.0F}, {100.0F, 397.5F}}));
}

TEST_F(Checks, ALineIsCutAtTheBorder) {
  CutAtBorderCheck check(30.0);
  EXPECT_EQ(check.reason(), LossReason::kBorder);
  EXPECT_TRUE(passes(check, {{-20.0F, 200.0F}, {100.0F, 200.0F}}));
  EXPECT_EQ(tracks_.line(0).segment.start, Eigen::Vector2f(2.0F, 200.0F));
  EXPECT_EQ(tracks_.line(0).segment.end, Eigen::Vector2f(100.0F, 200.0F));
}

TEST_F(Checks, ALineOfWhichTheBorderLeavesLessThanMinLengthIsLost) {
  CutAtBorderCheck check(30.0);
  EXPECT_TRUE(passes(check, {{-68.0F, 200.0F}, {33.0F, 200.0F}}));
  EXPECT_FALSE(passes(check, {{-70.0F, 200.0F}, {31.0F, 200.0F}}));
  EXPECT_FALSE(passes(check, {{-70.0F, 200.0F}, {-10.0F, 200.0F}}));
  // One that is not cut is for MinLengthCheck.
  EXPECT_TRUE(passes(check, ofLength(20.0F)));
}

TEST_F(Checks, ALineShorterThanMinLengthIsLost) {
  MinLengthCheck check(30.0);
  EXPECT_EQ(check.reason(), LossReason::kShort);
  EXPECT_TRUE(passes(check, ofLength(30.5F)));
  EXPECT_FALSE(passes(check, ofLength(29.5F)));
}

TEST_F(Checks, ALineIsCutWhereTheFieldOfViewEndsAndLostWhenTooLittleIsLeft) {
  CameraCalibration calibration;  // 190 degrees in a circle of 400 px
  calibration.model = "equidistant";
  calibration.fx = calibration.fy = 120.6;
  calibration.cx = 319.5;
  calibration.cy = 199.5;
  area_.setCamera(makeCameraModel(calibration));
  area_.setImageSize({640, 400});
  FieldOfViewCheck check(30.0);
  EXPECT_EQ(check.reason(), LossReason::kFieldOfView);
  EXPECT_TRUE(passes(check, {{320.0F, 200.0F}, {400.0F, 200.0F}}));
  EXPECT_EQ(statistics_.lines_cut, 0U);
  EXPECT_TRUE(passes(check, {{400.0F, 200.0F}, {600.0F, 200.0F}}));
  EXPECT_EQ(statistics_.lines_cut, 1U);
  EXPECT_EQ(tracks_.line(0).segment.start, Eigen::Vector2f(400.0F, 200.0F));
  EXPECT_LT(tracks_.line(0).segment.end.x(), 520.0F);
  EXPECT_EQ(statistics_.lines_left_out, 0U);
  EXPECT_FALSE(passes(check, {{530.0F, 100.0F}, {530.0F, 300.0F}}));
  EXPECT_EQ(statistics_.lines_left_out, 1U);
}

TEST_F(Checks, ALineIsLostWhenMoreThanHalfOfItIsMasked) {
  cv::Mat mask(400, 640, CV_8UC1, cv::Scalar(255));
  mask.colRange(160, 640).setTo(0);
  MaskCheck check;
  EXPECT_EQ(check.reason(), LossReason::kMask);
  EXPECT_TRUE(passes(check, ofLength(300.0F))) << "no mask";
  area_.setMask(mask);
  area_.setImageSize({640, 400});
  EXPECT_TRUE(passes(check, ofLength(100.0F)));
  EXPECT_FALSE(passes(check, ofLength(140.0F)));
}

TEST_F(Checks, ALineWhoseEdgeLiesFartherFromTheFlowThanIsUsualHasJumped) {
  for (int i = 0; i < 12; ++i) add(kHorizontal).edge_offset = 0.2F;
  tracks_.state(3).edge_offset = 1.1F;  // 0.2, usual, and 1.0, max_edge_offset, are over it
  tracks_.state(7).edge_offset = 1.3F;
  EdgeJumpCheck check(1.0);
  EXPECT_EQ(check.reason(), LossReason::kEdgeJump);
  check.apply(area_, tracks_, statistics_);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    EXPECT_EQ(tracks_.state(i).loss, i == 7 ? LossReason::kEdgeJump : LossReason::kCount) << i;
  }
}

TEST_F(Checks, WhatIsUsualForAnEdgeIsTakenFromTheLinesThatAreNotLost) {
  for (int i = 0; i < 12; ++i) add(kHorizontal).edge_offset = 0.2F;
  tracks_.state(0).edge_offset = 2.0F;
  for (int i = 0; i < 20; ++i) {
    TrackState& lost = add(kHorizontal);
    lost.edge_offset = 5.0F;
    lost.loss = LossReason::kSupport;
  }
  EdgeJumpCheck check(1.0);
  check.apply(area_, tracks_, statistics_);
  EXPECT_EQ(tracks_.state(0).loss, LossReason::kEdgeJump);
}

TEST_F(Checks, OfTwoTracksOnOneEdgeTheOlderOneLives) {
  add(kHorizontal);
  add({{120.0F, 201.0F}, {180.0F, 201.0F}});  // on the same edge
  add({{120.0F, 203.0F}, {180.0F, 203.0F}});  // beside it
  add({{180.0F, 201.0F}, {120.0F, 201.0F}});  // the other side of a dark line
  add({{230.0F, 200.0F}, {300.0F, 200.0F}});  // behind it
  DuplicateCheck check;
  EXPECT_EQ(check.reason(), LossReason::kDuplicate);
  for (int repeat = 0; repeat < 2; ++repeat) {
    check.apply(area_, tracks_, statistics_);
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      EXPECT_EQ(tracks_.state(i).loss, i == 1 ? LossReason::kDuplicate : LossReason::kCount) << i;
    }
  }
}

TEST_F(Checks, ATrackThatIsLostTakesNoDuplicateWithIt) {
  add(kHorizontal).loss = LossReason::kSupport;
  add({{120.0F, 201.0F}, {180.0F, 201.0F}});
  DuplicateCheck check;
  check.apply(area_, tracks_, statistics_);
  EXPECT_FALSE(tracks_.state(1).lost());
}

TEST_F(Checks, ALostTrackKeepsItsFirstReason) {
  // Fails every check there is.
  TrackState& state = add({{-30.0F, 200.0F}, {-10.0F, 200.0F}});
  state.predicted = {{-10.0F, 200.0F}, {-10.0F, 300.0F}};
  state.support = 0.0F;
  state.edge_offset = 9.0F;
  state.loss = LossReason::kFlow;
  for (int i = 0; i < 12; ++i) add(kHorizontal);
  tracks_.state(1).loss = LossReason::kFlow;
  TrackChecks checks;
  checks.push_back(std::make_unique<LengthRatioCheck>(1.5));
  checks.push_back(std::make_unique<AngleCheck>(0.2));
  checks.push_back(std::make_unique<SupportCheck>(0.5));
  checks.push_back(std::make_unique<EndpointsInImageCheck>());
  checks.push_back(std::make_unique<CutAtBorderCheck>(30.0));
  checks.push_back(std::make_unique<MinLengthCheck>(30.0));
  checks.push_back(std::make_unique<MaskCheck>());
  checks.push_back(std::make_unique<EdgeJumpCheck>(1.0));
  checks.push_back(std::make_unique<DuplicateCheck>());
  for (const auto& check : checks) {
    check->apply(area_, tracks_, statistics_);
    EXPECT_EQ(tracks_.state(0).loss, LossReason::kFlow);
    EXPECT_EQ(tracks_.state(1).loss, LossReason::kFlow);
  }
}

}  // namespace
}  // namespace tet_line_tracker
