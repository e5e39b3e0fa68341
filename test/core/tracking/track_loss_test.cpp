// Images in which LineTracker must lose lines for one known reason, or must not lose them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "rectangle_images.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 400);

/// Four boxes near the middle: sixteen lines.
const std::vector<Rectangle> kBoxes{{170.3F, 90.6F, 290.2F, 180.9F, 210.0F},
                                    {350.4F, 80.3F, 470.9F, 170.2F, 225.0F},
                                    {180.7F, 220.2F, 290.1F, 320.6F, 170.0F},
                                    {350.2F, 230.8F, 450.6F, 330.5F, 30.0F}};

cv::Mat boxes(const Similarity& placed = Similarity()) {
  return rectanglesImage(kSize, kBoxes, placed);
}

/// Without a motion prior, so that what happens to lines is the images' doing, and with one detection.
LineTrackerParameters parametersOf(const char* method) {
  LineTrackerParameters parameters;
  parameters.method = method;
  parameters.motion.prior = "none";
  parameters.flow.robust_patches = false;  // ends follow their corners far
  parameters.detection.detector = "edge";
  parameters.detection.min_lines = 1;
  parameters.detection.redetect_ratio = 0.0;
  return parameters;
}

/// A tracker that counts what it loses.
class Losses {
 public:
  explicit Losses(const LineTrackerParameters& parameters) : tracker_(parameters) {}

  const LineFrame& process(const cv::Mat& image) {
    const LineFrame& frame = *tracker_.process(image, 1000000000 + 50000000 * count_++).frame;
    for (std::size_t i = 0; i < lost_.size(); ++i) lost_[i] += frame.statistics.lost[i];
    return frame;
  }
  std::uint32_t of(LossReason reason) const { return lost_[static_cast<std::size_t>(reason)]; }
  std::uint32_t all() const { return std::accumulate(lost_.begin(), lost_.end(), 0U); }

 private:
  LineTracker tracker_;
  std::int64_t count_{0};
  std::array<std::uint32_t, static_cast<std::size_t>(LossReason::kCount)> lost_{};
};

TEST(TrackLoss, NoLineIsLostWhileTheSceneStandsStill) {
  for (const char* method : {"joint", "paper"}) {
    Losses losses(parametersOf(method));
    EXPECT_EQ(losses.process(boxes()).lines.size(), 16U);
    for (int k = 0; k < 5; ++k) losses.process(boxes());
    EXPECT_EQ(losses.all(), 0U) << method;
  }
}

TEST(TrackLoss, AnEdgeWithoutTextureAtItsEndsHasNoFlowInPaper) {
  Losses losses(parametersOf("paper"));
  const cv::Mat image = rectanglesImage(kSize, {{-100.0F, 201.3F, 900.0F, 900.0F, 200.0F}});
  ASSERT_EQ(losses.process(image).lines.size(), 1U);
  losses.process(image);
  EXPECT_EQ(losses.of(LossReason::kFlow), 1U);
  EXPECT_EQ(losses.all(), 1U);
}

/// Squares of `side` px, brighter and darker by `gray`.
cv::Mat withCheckerboard(const cv::Mat& image, int side, int gray) {
  cv::Mat disturbed = image.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int sign = (x / side + y / side) % 2 == 0 ? 1 : -1;
      disturbed.at<std::uint8_t>(y, x) =
          cv::saturate_cast<std::uint8_t>(image.at<std::uint8_t>(y, x) + sign * gray);
    }
  }
  return disturbed;
}

TEST(TrackLoss, LinesWhoseGrayValuesDoNotMatchAreLostForTheResidual) {
  for (const char* method : {"joint", "paper"}) {
    const bool joint = method == std::string("joint");
    Losses losses(parametersOf(method));
    losses.process(boxes());
    losses.process(withCheckerboard(boxes(), 6, joint ? 70 : 12));
    EXPECT_GE(losses.of(LossReason::kResidual), 12U) << method;
  }
}

TEST(TrackLoss, LinesThatGrowOrShrinkByMoreThanMaxLengthRatioAreLost) {
  for (const float scale : {1.12F, 1.0F / 1.12F}) {
    LineTrackerParameters parameters = parametersOf("joint");
    Losses kept(parameters);
    kept.process(boxes());
    kept.process(boxes({scale, 0.0F, {0.0F, 0.0F}}));
    EXPECT_LE(kept.all(), 1U) << scale;
    parameters.plausibility.max_length_ratio = 1.06;
    Losses losses(parameters);
    losses.process(boxes());
    losses.process(boxes({scale, 0.0F, {0.0F, 0.0F}}));
    EXPECT_GE(losses.of(LossReason::kLengthRatio), 12U) << scale;
  }
}

TEST(TrackLoss, LinesThatTurnByMoreThanMaxRotationAreLost) {
  for (const float angle : {0.06F, -0.06F}) {
    LineTrackerParameters parameters = parametersOf("joint");
    Losses kept(parameters);
    kept.process(boxes());
    kept.process(boxes({1.0F, angle, {0.0F, 0.0F}}));
    EXPECT_LE(kept.all(), 1U) << angle;
    parameters.plausibility.max_rotation = 0.03;
    Losses losses(parameters);
    losses.process(boxes());
    losses.process(boxes({1.0F, angle, {0.0F, 0.0F}}));
    EXPECT_GE(losses.of(LossReason::kAngle), 14U) << angle;
  }
}

TEST(TrackLoss, LinesWhoseEdgeFadesAwayAreLostForSupport) {
  cv::Mat faded;  // to a fifth of the contrast: the flow matches gain and offset, and finds them
  boxes().convertTo(faded, -1, 0.2, 0.8 * 110.0);
  LineTrackerParameters parameters = parametersOf("joint");
  Losses losses(parameters);
  losses.process(boxes());
  losses.process(faded);
  EXPECT_EQ(losses.of(LossReason::kSupport), 16U);
  parameters.refiner.refine = false;
  Losses kept(parameters);
  kept.process(boxes());
  kept.process(faded);
  EXPECT_EQ(kept.of(LossReason::kSupport), 0U);
}

TEST(TrackLoss, LinesThatLeaveTheImageAreLostAtTheBorder) {
  for (const char* method : {"joint", "paper"}) {
    Losses losses(parametersOf(method));
    for (int k = 0; k < 16; ++k) {
      const float shift = -10.0F * static_cast<float>(k);
      const LineFrame& frame =
          losses.process(rectanglesImage(kSize, {{105.3F + shift, 100.0F, 135.3F + shift, 300.0F, 200.0F}}));
      EXPECT_EQ(frame.lines.size(), k <= 10 ? 2U : k <= 13 ? 1U : 0U) << method << ", image " << k;
    }
    EXPECT_EQ(losses.of(LossReason::kBorder), 2U) << method;
    EXPECT_EQ(losses.all(), 2U) << method;
  }
}

TEST(TrackLoss, LinesThatLeaveTheImageWithOneEndAreCutThere) {
  Losses losses(parametersOf("joint"));
  for (int k = 0; k <= 40; ++k) {
    const float shift = 4.0F * static_cast<float>(k);
    const LineFrame& frame =
        losses.process(rectanglesImage(kSize, {{300.3F, 100.0F + shift, 330.6F, 350.0F + shift, 200.0F}}));
    ASSERT_EQ(frame.lines.size(), 2U);
    for (const TrackedLine& line : frame.lines) {
      const auto [top, bottom] = std::minmax(line.segment.start.y(), line.segment.end.y());
      EXPECT_NEAR(top, 102.0F + shift, 2.0F) << k;
      EXPECT_NEAR(bottom, std::min(348.0F + shift, 397.0F), 3.0F) << k;
      EXPECT_LE(bottom, 397.0F) << k;
    }
  }
}

TEST(TrackLoss, LinesThatShrinkUnderMinLengthAreLostAsShort) {
  LineTrackerParameters parameters = parametersOf("joint");
  parameters.detection.min_length = 80.0;
  Losses losses(parameters);
  EXPECT_EQ(losses.process(boxes()).lines.size(), 16U);
  losses.process(boxes({0.92F, 0.0F, {0.0F, 0.0F}}));
  losses.process(boxes({0.85F, 0.0F, {0.0F, 0.0F}}));
  // The upright sides of the upper boxes have 90 px; the others, 100 px and more, stay longer than 80 px.
  EXPECT_EQ(losses.of(LossReason::kShort), 4U);
  EXPECT_EQ(losses.all(), 4U);
}

TEST(TrackLoss, OfTwoEdgesThatBecomeOneTheOlderTrackLives) {
  // A flight of two steps, 9 px apart at first.
  const auto steps = [](float apart) {
    return rectanglesImage(
        kSize, {{200.0F, 100.0F, 450.0F, 300.0F, 150.0F}, {220.0F, 100.0F + apart, 430.0F, 300.0F, 200.0F}});
  };
  LineTrackerParameters parameters = parametersOf("joint");
  Losses losses(parameters);
  losses.process(steps(9.0F));
  for (const float apart : {7.5F, 6.0F, 4.5F, 3.0F, 1.5F, 0.0F, 0.0F}) losses.process(steps(apart));
  EXPECT_EQ(losses.of(LossReason::kDuplicate), 1U);
}

TEST(TrackLoss, ALineWhoseEdgeIsNotWhereTheFlowEndsHasJumped) {
  // A weak edge that moves beside a strong one that stands still: the patches show more of the strong one.
  const auto scene = [](float shift) {
    std::vector<Rectangle> rectangles = kBoxes;
    rectangles.push_back({170.3F, 84.6F + shift, 290.2F, 90.6F, 140.0F});
    return rectanglesImage(kSize, rectangles);
  };
  LineTrackerParameters parameters;
  parameters.motion.prior = "none";
  for (const double max_edge_offset : {0.8, 10.0}) {
    parameters.plausibility.max_edge_offset = max_edge_offset;
    Losses losses(parameters);
    EXPECT_EQ(losses.process(scene(0.0F)).lines.size(), 17U);
    losses.process(scene(1.7F));
    EXPECT_EQ(losses.of(LossReason::kEdgeJump), max_edge_offset < 5.0 ? 1U : 0U);
    EXPECT_EQ(losses.all(), losses.of(LossReason::kEdgeJump));
  }
}

/// Where a long bar is in the second image, and what of it can be seen.
struct BarView {
  float seen{600.0F};                    ///< of its length, from its left end [px]
  float tilt{0.0F};                      ///< [rad]
  float gap_start{0.0F}, gap_end{0.0F};  ///< without an edge, from its left end [px]
};
constexpr float kBarLength = 600.0F;

/// The bar between boxes, through a long lens that has turned: everything has moved by the same way.
cv::Mat barWithBoxes(const BarView& view) {
  const float left = static_cast<float>(kSize.width - 3) - view.seen;
  std::vector<Rectangle> boxes;
  for (int i = -4; i < 5; ++i) {
    const auto x = static_cast<float>(70 * i);
    const auto y = static_cast<float>(13 * (i * i % 5));
    boxes.push_back({x, 40.0F + y, x + 45.0F, 110.0F - 0.5F * y, 180.0F});
    boxes.push_back({x + 20.0F, 280.0F + y, x + 62.0F, 370.0F - y, 50.0F});
  }
  cv::Mat image = rectanglesImage(kSize, boxes, {1.0F, 0.0F, {left, 0.0F}});
  constexpr int kShift = 8;
  const auto corner = [&](float along, float y) {
    constexpr float kScale = 1 << kShift;
    return cv::Point(static_cast<int>(std::lround(kScale * (left + along))),
                     static_cast<int>(std::lround(kScale * (y + view.tilt * along))));
  };
  const std::vector<cv::Point> bar{corner(0.0F, 190.0F), corner(kBarLength, 190.0F),
                                   corner(kBarLength, 210.0F), corner(0.0F, 210.0F)};
  cv::fillConvexPoly(image, bar, cv::Scalar(220), cv::LINE_AA, kShift);
  if (view.gap_end > view.gap_start) {
    image(cv::Rect(cv::Point(static_cast<int>(left + view.gap_start), 180),
                   cv::Point(static_cast<int>(left + view.gap_end), 230)))
        .setTo(110);
  }
  return image;
}

/// How many edges of the bar go on when the lens turns at once from where it shows all of it.
std::uint32_t followedEdgesOfBar(const BarView& view) {
  constexpr double kFocal = 5000.0;
  constexpr std::int64_t kFirst = 1000000000, kStep = 50000000;
  LineTrackerParameters parameters;
  parameters.motion.prior = "imu";
  parameters.motion.ego_motion = false;
  parameters.detection.redetect_ratio = 0.0;
  LineTracker tracker(parameters);
  CameraCalibration lens;
  lens.fx = lens.fy = kFocal;
  lens.cx = 320.0;
  lens.cy = 200.0;
  lens.width = kSize.width;
  lens.height = kSize.height;
  tracker.setCamera(makeCameraModel(lens));
  tracker.setImuRotation(Eigen::Matrix3d::Identity());
  const double rate = static_cast<double>(view.seen - BarView().seen) / kFocal * 1e9 / kStep;
  for (int k = -1; k < 12; ++k) tracker.addAngularVelocity(kFirst + k * kStep / 10, {0.0, rate, 0.0});
  const LineFrame before = *tracker.process(barWithBoxes({}), kFirst).frame;
  const LineFrame after = *tracker.process(barWithBoxes(view), kFirst + kStep).frame;
  EXPECT_EQ(after.statistics.prior, "imu");
  std::uint32_t count = 0;
  for (const TrackedLine& line : before.lines) {
    if (line.segment.length() < 500.0F) continue;
    const float y = line.segment.middle().y() + 0.5F * view.tilt * view.seen;
    for (const TrackedLine& other : after.lines) {
      if (other.id != line.id) continue;
      ++count;
      EXPECT_NEAR(other.segment.middle().y(), y, 0.2F);
    }
  }
  return count;
}

TEST(TrackLoss, AFewPixelsOfALongLineAreEnoughWhenTheRestLeavesTheImage) {
  EXPECT_EQ(followedEdgesOfBar({45.0F}), 2U);
  EXPECT_EQ(followedEdgesOfBar({25.0F}), 0U) << "shorter than min_length";
}

TEST(TrackLoss, HowFarAnEdgeHasJumpedIsSeenInTheImageNotBeyondIt) {
  EXPECT_EQ(followedEdgesOfBar({60.0F, 0.02F}), 2U);
}

TEST(TrackLoss, MoreOfALineMustLieOnAnEdgeWhenTheBorderHasJustCutIt) {
  EXPECT_EQ(followedEdgesOfBar({100.0F, 0.0F, 40.0F, 70.0F}), 2U);
  EXPECT_EQ(followedEdgesOfBar({100.0F, 0.0F, 40.0F, 84.0F}), 0U)
      << "enough for a line that is all in the image";
}

/// Of the upright lines of the first image, those that are still on their edges in the last one, after a
/// movement across them that becomes faster by 2 px per image up to 26 px.
std::size_t followed(bool predict_parallax) {
  LineTrackerParameters parameters;
  parameters.motion.prior = "none";
  parameters.motion.predict_parallax = predict_parallax;
  LineTracker tracker(parameters);
  std::map<std::uint64_t, LineSegment> first;
  std::size_t right = 0;
  Eigen::Vector2f shift(-130.0F, 0.0F);
  for (int k = 0; k < 14; ++k) {
    shift.x() += 2.0F * static_cast<float>(k);
    const LineFrame& frame =
        *tracker.process(boxes({1.0F, 0.0F, shift}), 1000000000 + 50000000 * static_cast<std::int64_t>(k))
             .frame;
    right = 0;
    for (const TrackedLine& line : frame.lines) {
      if (k == 0) first[line.id] = {line.segment.start - shift, line.segment.end - shift};
      if (first.count(line.id) == 0 || std::abs(line.segment.direction().x()) > 0.5F) continue;
      if ((line.segment.start - first[line.id].start - shift).norm() < 5.0F) ++right;
    }
  }
  return right;
}

TEST(PredictedParallax, KeepsTheLinesThatMoveFasterAndFasterAcrossThemselves) {
  EXPECT_EQ(followed(true), 8U);
  EXPECT_LE(followed(false), 5U);
}

}  // namespace
}  // namespace tet_line_tracker
