#include "tracking/track_follower.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "synthetic_images.h"

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kCoarse = kWidth / 4;  ///< width of the levels that the flow visits
constexpr int kFine = kWidth / 2;

/// Finds every line where it is expected, or on no level, and remembers the levels that it saw.
class RecordingFlow : public EndpointTracker {
 public:
  explicit RecordingFlow(std::vector<int>& widths) : EndpointTracker({}, {1, 2, true}), widths_(widths) {}
  bool finds{true};

 private:
  Status trackOnLevel(const PatchRow&, const cv::Mat& image, bool, LineCurve&, float&) const override {
    widths_.push_back(image.cols);
    return finds ? Status::kTracked : Status::kNoSolution;
  }
  std::vector<int>& widths_;
};

class TrackFollowerTest : public testing::Test {
 protected:
  TrackFollowerTest() {
    auto flow = std::make_unique<RecordingFlow>(widths_);
    flow_ = flow.get();
    method_.flow = std::move(flow);
    pyramid_.build(image_, 3);
    area_.setImageSize(image_.size());
    line_.segment = {{100.0F, 80.0F}, {200.0F, 150.0F}};
    line_.start_normalized = {-0.2, -0.1};
    line_.end_normalized = {0.1, 0.1};
    motion_.source = MotionPrediction::Source::kImage;
    motion_.confirmed = true;
    motion_.step_ratio = 1.0;
  }

  /// Widths of the levels at which the line is looked for.
  std::vector<int> follow() {
    follower_.renewTemplate(pyramid_, line_, state_);
    widths_.clear();
    follower_.follow(motion_, pyramid_, line_, state_);
    return widths_;
  }

  void translateWithDepthOf(double deviation) {
    motion_.translation = Eigen::Vector3d::UnitX();
    state_.depth.known = true;
    state_.depth.inverse.setConstant(0.1);
    state_.depth.variance.setConstant(deviation * deviation);
  }

  const cv::Mat image_ = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  std::vector<int> widths_;
  RecordingFlow* flow_;
  TrackingMethod method_;
  MotionPrior prior_{MotionPriorParameters{}};  // of a focal length of 1 px before the first image
  VisibleArea area_{0.0};
  ImagePyramid pyramid_;
  TrackFollower follower_{method_, prior_, area_, pyramid_};
  MotionPrediction motion_;
  TrackedLine line_;
  TrackState state_;
};

const std::vector<int> kFromCoarse{kCoarse, kFine};
const std::vector<int> kFineAlone{kFine};

TEST_F(TrackFollowerTest, TheFinestLevelIsEnoughWhereCornersConfirmARotation) {
  EXPECT_EQ(follow(), kFineAlone);
}

TEST_F(TrackFollowerTest, ARotationThatNoCornerConfirmsNeedsTheCoarsestLevel) {
  motion_.confirmed = false;
  EXPECT_EQ(follow(), kFromCoarse);
}

TEST_F(TrackFollowerTest, WhatIsNotNearItsPlaceIsLookedForFromTheCoarsestLevel) {
  flow_->finds = false;
  EXPECT_EQ(follow(), (std::vector<int>{kFine, kCoarse}));  // where it is not found, so no further
}

TEST_F(TrackFollowerTest, UnderTranslationALineNeedsAKnownDepthToBeLookedForOnTheFinestLevelAlone) {
  motion_.translation = Eigen::Vector3d::UnitX();
  EXPECT_EQ(follow(), kFromCoarse);
  translateWithDepthOf(0.1);
  EXPECT_EQ(follow(), kFineAlone);
  translateWithDepthOf(100.0);
  EXPECT_EQ(follow().front(), kCoarse);
}

TEST_F(TrackFollowerTest, ATemplateThatIsKeptGetsItsCoarseLevelsFromItsOwnImage) {
  const std::unique_ptr<EndpointTracker> flow = makeJointFlow({});
  TrackingMethod method;
  method.flow = makeJointFlow({});
  const TrackFollower follower(method, prior_, area_, pyramid_);
  follower.renewTemplate(pyramid_, line_, state_);
  state_.template_due = false;
  ImagePyramid moved;
  const cv::Mat moved_image = smoothImage(kWidth, kHeight, {6.0F, 3.0F});
  moved.build(moved_image, 3);
  follower.renewTemplate(moved, line_, state_);
  const EndpointFlow kept = flow->track(state_.patches, moved, line_.segment);
  LineTemplate whole;
  flow->extractTemplate(pyramid_, line_.segment, whole);
  EXPECT_EQ(kept.segment.start, flow->track(whole, moved, line_.segment).segment.start);
}

}  // namespace
}  // namespace tet_line_tracker
