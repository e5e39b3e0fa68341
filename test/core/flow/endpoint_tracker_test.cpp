#include "tet_line_tracker/flow/endpoint_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "synthetic_images.h"

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
const LineSegment kLine{{100.4F, 80.7F}, {201.3F, 150.2F}};

EndpointFlow followInto(const EndpointTracker& tracker, const cv::Mat& first_image,
                        const cv::Mat& second_image, int levels = 3) {
  ImagePyramid first, second;
  first.build(first_image, levels);
  second.build(second_image, levels);
  LineTemplate patches;
  tracker.extractTemplate(first, kLine, patches);
  return tracker.track(patches, second, kLine);
}

EndpointFlow followShift(const EndpointTracker& tracker, const Eigen::Vector2f& shift, int levels = 3) {
  return followInto(tracker, smoothImage(kWidth, kHeight, {0.0F, 0.0F}), smoothImage(kWidth, kHeight, shift),
                    levels);
}

EndpointFlow followShift(const EndpointTrackerParameters& parameters, const Eigen::Vector2f& shift) {
  return followShift(*makeTwoEndpointFlow(parameters), shift, parameters.pyramid_levels);
}

TEST(TwoEndpointFlow, RecoversShiftsOfATenthToTenPixelsToWithinATwentieth) {
  for (const float length : {0.1F, 0.25F, 0.5F, 0.9F, 1.0F, 2.3F, 3.5F, 5.0F, 7.7F, 10.0F}) {
    for (const Eigen::Vector2f& direction : {Eigen::Vector2f(1.0F, 0.0F), Eigen::Vector2f(0.0F, 1.0F),
                                             Eigen::Vector2f(0.6F, -0.8F), Eigen::Vector2f(-0.8F, -0.6F)}) {
      const Eigen::Vector2f shift = length * direction;
      const EndpointFlow flow = followShift(EndpointTrackerParameters{}, shift);
      ASSERT_EQ(flow.status, EndpointFlow::Status::kTracked) << "shift " << shift.transpose();
      EXPECT_LT((flow.segment.start - kLine.start - shift).norm(), 0.05F) << "shift " << shift.transpose();
      EXPECT_LT((flow.segment.end - kLine.end - shift).norm(), 0.05F) << "shift " << shift.transpose();
    }
  }
}

TEST(TwoEndpointFlow, EndpointsScaleByTwoBetweenLevelsWithoutAnOffset) {
  // With one iteration on each level the coarse estimate must arrive at the right place of the fine one: any
  // wrong factor or half-pixel shift between levels would stay as an error of half a pixel and more.
  EndpointTrackerParameters parameters;
  parameters.pyramid_levels = 4;
  for (const float shift : {-2.0F, 0.0F, 1.5F}) {
    const EndpointFlow flow = followShift(parameters, {shift, shift});
    ASSERT_EQ(flow.status, EndpointFlow::Status::kTracked);
    EXPECT_LT((flow.segment.start - kLine.start - Eigen::Vector2f(shift, shift)).norm(), 0.03F);
  }
}

TEST(TwoEndpointFlow, ALargeShiftNeedsThePyramid) {
  EndpointTrackerParameters one_level;
  one_level.pyramid_levels = 1;
  const Eigen::Vector2f shift(9.0F, -9.0F);
  const EndpointFlow without = followShift(one_level, shift);
  const EndpointFlow with = followShift(EndpointTrackerParameters{}, shift);
  EXPECT_EQ(with.status, EndpointFlow::Status::kTracked);
  EXPECT_LT((with.segment.start - kLine.start - shift).norm(), 0.05F);
  EXPECT_GT((without.segment.start - kLine.start - shift).norm(), 1.0F);
}

TEST(TwoEndpointFlow, ALineWhoseGrayValuesChangeIsAnOutlierHoweverManyIterations) {
  const auto tracker = makeTwoEndpointFlow({});
  const cv::Mat image = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  ImagePyramid first, second;
  first.build(image, 3);
  LineTemplate patches;
  tracker->extractTemplate(first, kLine, patches);
  // A coarse checkerboard over the picture adds a residual that no small movement takes away.
  const auto followUnder = [&](int gray) {
    cv::Mat disturbed = image.clone();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        disturbed.at<std::uint8_t>(y, x) += ((x / 4 + y / 4) % 2 == 0 ? gray : -gray);
    }
    second.build(disturbed, 3);
    return tracker->track(patches, second, kLine);
  };
  const EndpointFlow lost = followUnder(12);  // 12 / 255 = 0.047 is over the threshold of 0.02
  EXPECT_EQ(lost.status, EndpointFlow::Status::kHighResidual);
  EXPECT_GT(lost.residual, 0.02F);
  EXPECT_EQ(followUnder(3).status, EndpointFlow::Status::kTracked);  // 0.012 is under it
}

TEST(TwoEndpointFlow, BothEndpointsMustMeetTheResidual) {
  const auto tracker = makeTwoEndpointFlow({});
  const cv::Mat image = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  cv::Mat half_covered = image.clone();
  cv::circle(half_covered, cv::Point(201, 150), 12, cv::Scalar(255), cv::FILLED);
  ImagePyramid first, second;
  first.build(image, 3);
  second.build(half_covered, 3);
  LineTemplate patches;
  tracker->extractTemplate(first, kLine, patches);
  EXPECT_NE(tracker->track(patches, second, kLine).status, EndpointFlow::Status::kTracked);
}

TEST(TwoEndpointFlow, TheResidualIsThatOfTheWorseEndpoint) {
  const cv::Mat image = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  for (const Eigen::Vector2f& disturbed : {kLine.start, kLine.end}) {
    cv::Mat second = image.clone();
    for (int y = -8; y <= 8; ++y) {
      for (int x = -8; x <= 8; ++x) {
        std::uint8_t& gray =
            second.at<std::uint8_t>(static_cast<int>(disturbed.y()) + y, static_cast<int>(disturbed.x()) + x);
        gray = static_cast<std::uint8_t>(gray + (((x + 8) / 4 + (y + 8) / 4) % 2 == 0 ? 3 : -3));
      }
    }
    const EndpointFlow flow = followInto(*makeTwoEndpointFlow({}), image, second);
    EXPECT_EQ(flow.status, EndpointFlow::Status::kTracked);
    EXPECT_GT(flow.residual, 0.007F) << "of 3 / 255, less what interpolation takes away";
  }
}

TEST(TwoEndpointFlow, TheIterationsEndAtTheirLimit) {
  EndpointTrackerParameters once;
  once.pyramid_levels = 1;
  once.max_iterations = 1;
  EndpointTrackerParameters often = once;
  often.max_iterations = 10;
  const Eigen::Vector2f shift(1.6F, -1.1F);
  const float error_once = (followShift(once, shift).segment.start - kLine.start - shift).norm();
  const float error_often = (followShift(often, shift).segment.start - kLine.start - shift).norm();
  EXPECT_GT(error_once, 2.0F * error_often);
  EXPECT_LT(error_often, 0.05F);
}

TEST(TwoEndpointFlow, WithoutTextureThereIsNoSolution) {
  const auto tracker = makeTwoEndpointFlow({});
  const cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(100));
  ImagePyramid pyramid;
  pyramid.build(image, 3);
  LineTemplate patches;
  tracker->extractTemplate(pyramid, kLine, patches);
  EXPECT_EQ(tracker->track(patches, pyramid, kLine).status, EndpointFlow::Status::kNoSolution);
}

TEST(TwoEndpointFlow, AnEndpointThatLeavesTheImageIsSaidToBeOutside) {
  const auto tracker = makeTwoEndpointFlow({});
  const Eigen::Vector2f shift(-9.0F, 0.0F);
  const cv::Mat first_image = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  const cv::Mat second_image = smoothImage(kWidth, kHeight, shift);
  ImagePyramid first, second;
  first.build(first_image, 3);
  second.build(second_image, 3);
  const LineSegment at_border{{4.0F, 80.0F}, {100.0F, 90.0F}};
  LineTemplate patches;
  tracker->extractTemplate(first, at_border, patches);
  EXPECT_EQ(tracker->track(patches, second, at_border).status, EndpointFlow::Status::kOutside);
}

/// The joint flow down to the full image, without the re-fit that follows it in the tracker.
std::unique_ptr<EndpointTracker> joint(bool gain_and_offset = true) {
  EndpointTrackerParameters parameters;
  parameters.finest_level = 0;
  parameters.gain_and_offset = gain_and_offset;
  return makeJointFlow(parameters);
}

TEST(JointFlow, RecoversShiftsToWithinATenth) {
  for (const float length : {0.3F, 1.0F, 3.5F, 10.0F}) {
    const Eigen::Vector2f shift = length * Eigen::Vector2f(0.6F, -0.8F);
    const EndpointFlow flow = followShift(*joint(), shift);
    ASSERT_NE(flow.status, EndpointFlow::Status::kNoSolution) << length;
    EXPECT_LT((flow.segment.start - kLine.start - shift).norm(), 0.1F) << length;
    EXPECT_LT((flow.segment.end - kLine.end - shift).norm(), 0.1F) << length;
  }
}

TEST(JointFlow, AChangeOfGainAndOffsetDoesNotMoveALine) {
  const Eigen::Vector2f shift(2.0F, 1.0F);
  const cv::Mat first = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  cv::Mat second;
  smoothImage(kWidth, kHeight, shift).convertTo(second, -1, 0.6, 30.0);
  const auto errorOf = [&](const EndpointTracker& tracker) {
    const EndpointFlow flow = followInto(tracker, first, second);
    return std::max((flow.segment.start - kLine.start - shift).norm(),
                    (flow.segment.end - kLine.end - shift).norm());
  };
  EXPECT_LT(errorOf(*joint(true)), 0.1F);
  EXPECT_GT(errorOf(*joint(false)), 0.3F);
}

TEST(JointFlow, ACoveredEndDoesNotPullTheLineAway) {
  const Eigen::Vector2f shift(1.5F, -1.0F);
  const cv::Mat first = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  cv::Mat second = smoothImage(kWidth, kHeight, shift);
  cv::circle(second, cv::Point(203, 149), 14, cv::Scalar(250), cv::FILLED);
  const EndpointFlow flow = followInto(*joint(), first, second);
  ASSERT_NE(flow.status, EndpointFlow::Status::kNoSolution);
  EXPECT_LT((flow.segment.start - kLine.start - shift).norm(), 0.2F);
  EXPECT_LT(std::abs(flow.segment.distance(kLine.middle() + shift)), 0.2F);
}

TEST(JointFlow, AlongABareEdgeEndpointsHardlySlide) {
  // Nothing but an edge: across it the place is known, along it only the expectation is.
  const auto edge = [](float shift) {
    cv::Mat image(kHeight, kWidth, CV_8UC1);
    const Eigen::Vector2f normal = kLine.normal();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float distance =
            normal.dot(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - kLine.start) - shift;
        image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(120.0F + 60.0F * std::erf(distance));
      }
    }
    return image;
  };
  const EndpointFlow flow = followInto(*joint(), edge(0.0F), edge(2.0F));
  EXPECT_NEAR(kLine.distance(flow.segment.start), 2.0F, 0.1F);
  EXPECT_NEAR(kLine.distance(flow.segment.end), 2.0F, 0.1F);
  EXPECT_NEAR(kLine.along(flow.segment.start), 0.0F, 4.0F);
  EXPECT_NEAR(kLine.along(flow.segment.end), kLine.length(), 4.0F);
}

/// A ramp: a shift of `shift` px to the right makes each pixel darker by 3 gray per px.
cv::Mat ramp(float shift) {
  cv::Mat image(kHeight, 80, CV_8UC1);
  for (int x = 0; x < image.cols; ++x) {
    image.col(x).setTo(cv::Scalar(std::lround(3.0F * (static_cast<float>(x) - shift))));
  }
  return image;
}

TEST(JointFlow, TakesNoMoreStepsThanMaxIterations) {
  EndpointTrackerParameters once;
  once.pyramid_levels = 1;
  once.finest_level = 0;
  once.gain_and_offset = false;
  once.max_iterations = 1;
  const LineSegment line{{40.0F, 60.0F}, {40.0F, 160.0F}};
  ImagePyramid first, second;
  first.build(ramp(0.0F), 1);
  second.build(ramp(2.0F), 1);
  const auto tracker = makeJointFlow(once);
  LineTemplate patches;
  tracker->extractTemplate(first, line, patches);
  // The residual is that of the place before the only step: 2 px on a ramp of 3 gray per px.
  EXPECT_NEAR(tracker->track(patches, second, line).residual, 6.0F / 255.0F, 1e-4F);
}

TEST(JointFlow, AMovementOfMoreThanAWindowOnALevelIsNoSolution) {
  EndpointTrackerParameters parameters;
  parameters.pyramid_levels = 1;
  parameters.finest_level = 0;
  parameters.gain_and_offset = false;
  const auto tracker = makeJointFlow(parameters);
  const LineSegment line{{40.0F, 60.0F}, {40.0F, 160.0F}};
  ImagePyramid first, second;
  first.build(ramp(0.0F), 1);
  LineTemplate patches;
  tracker->extractTemplate(first, line, patches);
  second.build(ramp(5.0F), 1);
  EXPECT_EQ(tracker->track(patches, second, line).status, EndpointFlow::Status::kTracked);
  second.build(ramp(9.0F), 1);
  EXPECT_EQ(tracker->track(patches, second, line).status, EndpointFlow::Status::kNoSolution);
}

TEST(JointFlow, ALineThatMatchesPoorlyIsStillPlacedOnTheFinestLevel) {
  const Eigen::Vector2f shift(1.4F, -0.9F);
  const cv::Mat first = smoothImage(kWidth, kHeight, {0.0F, 0.0F});
  cv::Mat second = smoothImage(kWidth, kHeight, shift);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) second.at<std::uint8_t>(y, x) += (x / 4 + y / 4) % 2 == 0 ? 12 : -12;
  }
  const EndpointFlow flow = followInto(*joint(), first, second);
  ASSERT_EQ(flow.status, EndpointFlow::Status::kTracked);
  EXPECT_GT(flow.residual, EndpointTrackerParameters{}.max_residual);
  // On the levels above the checks are gone, so these alone give the place of the finest one but for its last
  // step.
  EndpointTrackerParameters coarse;
  coarse.finest_level = 1;
  const EndpointFlow above = followInto(*makeJointFlow(coarse), first, second);
  EXPECT_GT((flow.segment.start - above.segment.start).norm(), 1e-3F);
  EXPECT_LT((flow.segment.start - kLine.start - shift).norm(), 0.1F);
}

TEST(EndpointTracker, RefusesParametersOutOfRangeAndTemplatesOfAnotherWindow) {
  EndpointTrackerParameters parameters;
  parameters.window_px = 31;
  EXPECT_THROW(makeJointFlow(parameters), std::invalid_argument);
  EXPECT_THROW(makeTwoEndpointFlow(parameters), std::invalid_argument);
  parameters.window_px = 9;
  const auto other = makeJointFlow(parameters);
  ImagePyramid pyramid;
  pyramid.build(smoothImage(kWidth, kHeight, {0.0F, 0.0F}), 3);
  LineTemplate patches;
  joint()->extractTemplate(pyramid, kLine, patches);
  EXPECT_THROW(other->track(patches, pyramid, kLine), std::invalid_argument);
  // Extracted again, the template is of the other window.
  other->extractTemplate(pyramid, kLine, patches);
  EXPECT_EQ(other->track(patches, pyramid, kLine).status, EndpointFlow::Status::kTracked);
}

/// A flow that begins on the finest level, by the template that is made for it.
EndpointFlow followNear(const Eigen::Vector2f& shift) {
  const auto tracker = joint();
  ImagePyramid first, second;
  first.build(smoothImage(kWidth, kHeight, {0.0F, 0.0F}), 3);
  second.build(smoothImage(kWidth, kHeight, shift), 3);
  LineTemplate patches;
  tracker->extractTemplate(first, kLine, patches, EndpointTracker::Reach::kNear);
  return tracker->track(patches, second, kLine, EndpointTracker::Reach::kNear);
}

TEST(EndpointTracker, FindsALineNearItsPlaceOnTheFinestLevelAlone) {
  const Eigen::Vector2f shift(2.0F, -1.5F);
  const EndpointFlow flow = followNear(shift);
  ASSERT_EQ(flow.status, EndpointFlow::Status::kTracked);
  EXPECT_LT((flow.segment.start - kLine.start - shift).norm(), 0.1F);
  EXPECT_LT((flow.segment.end - kLine.end - shift).norm(), 0.1F);
}

TEST(EndpointTracker, TheFinestLevelAloneDoesNotReachFar) {
  const Eigen::Vector2f shift(9.0F, -9.0F);
  EXPECT_NE(followNear(shift).status, EndpointFlow::Status::kTracked);
  EXPECT_EQ(followShift(*joint(), shift).status, EndpointFlow::Status::kTracked);
}

TEST(EndpointTracker, ATemplateOfTheFinestLevelIsRefusedWhereAllAreNeeded) {
  const auto tracker = joint();
  ImagePyramid pyramid;
  pyramid.build(smoothImage(kWidth, kHeight, {0.0F, 0.0F}), 3);
  LineTemplate patches;
  tracker->extractTemplate(pyramid, kLine, patches, EndpointTracker::Reach::kNear);
  EXPECT_THROW(tracker->track(patches, pyramid, kLine), std::invalid_argument);
  LinePath path;
  path.chords[0] = kLine;
  path.count = 1;
  std::array<LineSegment, EndpointTracker::kMaxStarts> best;
  EXPECT_THROW(tracker->search(patches, pyramid, path, best), std::invalid_argument);
}

TEST(EndpointTracker, AnExtendedTemplateIsAsOneThatWasWholeFromTheStart) {
  const auto tracker = joint();
  ImagePyramid first, second;
  first.build(smoothImage(kWidth, kHeight, {0.0F, 0.0F}), 3);
  second.build(smoothImage(kWidth, kHeight, {7.0F, 3.0F}), 3);
  LineTemplate whole, extended;
  tracker->extractTemplate(first, kLine, whole);
  tracker->extractTemplate(first, kLine, extended, EndpointTracker::Reach::kNear);
  tracker->extendTemplate(first, extended);
  const EndpointFlow a = tracker->track(whole, second, kLine);
  // What is whole already stays as it is.
  tracker->extendTemplate(second, extended);
  const EndpointFlow b = tracker->track(extended, second, kLine);
  EXPECT_EQ(a.status, EndpointFlow::Status::kTracked);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.segment.start, b.segment.start);
  EXPECT_EQ(a.segment.end, b.segment.end);
  EXPECT_EQ(a.residual, b.residual);
}

}  // namespace
}  // namespace tet_line_tracker
