// Where lines may lie, and which of their ends VisibleArea reports as cut.
#include "tracking/visible_area.h"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rectangle_images.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 400);
constexpr float kBorder = 2.0F;

VisibleArea areaWith(const std::shared_ptr<const CameraModel>& camera = nullptr,
                     const cv::Mat& mask = cv::Mat()) {
  VisibleArea area(kBorder);
  area.setCamera(camera);
  area.setMask(mask);
  area.setImageSize(kSize);
  return area;
}

/// 190 degrees in a circle of 200 px around the middle.
std::shared_ptr<const CameraModel> wideCamera() {
  CameraCalibration calibration;
  calibration.model = "equidistant";
  calibration.fx = calibration.fy = 120.6;
  calibration.cx = 319.5;
  calibration.cy = 199.5;
  return makeCameraModel(calibration);
}

/// White to the left of x = 300.
cv::Mat leftMask() {
  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(0));
  mask.colRange(0, 300).setTo(255);
  return mask;
}

int cuts(const VisibleArea& area, const LineSegment& line) {
  return area.cutsOf(area.lens().curve(line));
}

TEST(CutFlags, ALineThatEndsInTheImageHasNone) {
  EXPECT_EQ(cuts(areaWith(), {{100.0F, 100.0F}, {500.0F, 300.0F}}), 0);
  EXPECT_EQ(cuts(areaWith(wideCamera()), {{250.0F, 150.0F}, {400.0F, 250.0F}}), 0);
  EXPECT_EQ(cuts(areaWith(nullptr, leftMask()), {{100.0F, 100.0F}, {290.0F, 200.0F}}), 0);
}

TEST(VisibleArea, AnotherBorderHoldsFromTheNextImageOn) {
  VisibleArea area(150.0);  // within it this camera can normalise all pixels
  area.setCamera(wideCamera());
  area.setImageSize(kSize);
  area.setBorder(kBorder);
  area.setImageSize(kSize);
  FrameStatistics statistics;
  LineCurve line = area.lens().curve({{100.0F, 200.0F}, {400.0F, 200.0F}});
  ASSERT_TRUE(area.cutToFieldOfView(0.0F, line, statistics));
  EXPECT_GT(line.chord.start.x(), 115.0F);
  area.setBorder(150.0);
  area.setImageSize(kSize);
  ASSERT_TRUE(area.cutToBounds(0.0F, line));
  EXPECT_NEAR(line.chord.start.x(), 150.0F, 0.5F);
}

TEST(CutFlags, AnEndAtAnyBorderHasItsOwnBit) {
  const VisibleArea area = areaWith();
  const Eigen::Vector2f inside(320.0F, 200.0F);
  for (const Eigen::Vector2f& at_border :
       {Eigen::Vector2f(kBorder, 150.0F), Eigen::Vector2f(639.0F - kBorder, 150.0F),
        Eigen::Vector2f(250.0F, kBorder), Eigen::Vector2f(250.0F, 399.0F - kBorder)}) {
    EXPECT_EQ(cuts(area, {at_border, inside}), kStartCut) << at_border.transpose();
    EXPECT_EQ(cuts(area, {inside, at_border}), kEndCut) << at_border.transpose();
  }
  EXPECT_EQ(cuts(area, {{kBorder, 150.0F}, {639.0F - kBorder, 250.0F}}), kStartCut | kEndCut);
}

TEST(CutFlags, AnEndBesideTheBorderOfALineAlongItHasNone) {
  EXPECT_EQ(cuts(areaWith(), {{100.0F, kBorder}, {500.0F, kBorder}}), 0);
}

TEST(CutFlags, AnEndWhereTheMaskBeginsHasItsOwnBit) {
  const VisibleArea area = areaWith(nullptr, leftMask());
  EXPECT_EQ(cuts(area, {{298.0F, 200.0F}, {150.0F, 200.0F}}), kStartCut);
  EXPECT_EQ(cuts(area, {{150.0F, 200.0F}, {298.0F, 200.0F}}), kEndCut);
}

TEST(CutFlags, AMaskOfAnotherSizeCutsNothing) {
  const VisibleArea area = areaWith(nullptr, cv::Mat(100, 100, CV_8UC1, cv::Scalar(0)));
  EXPECT_EQ(cuts(area, {{150.0F, 200.0F}, {298.0F, 200.0F}}), 0);
}

TEST(CutFlags, AnEndWhereTheFieldOfViewEndsHasItsOwnBit) {
  const VisibleArea area = areaWith(wideCamera());
  FrameStatistics statistics;
  for (const bool outward : {true, false}) {
    LineSegment line{{320.0F, 200.0F}, {600.0F, 210.0F}};
    if (!outward) std::swap(line.start, line.end);
    LineCurve curve(line);
    ASSERT_TRUE(area.cutToFieldOfView(30.0F, curve, statistics));
    EXPECT_LT(curve.chord.length(), 0.9F * line.length()) << "the lens must cut the line";
    EXPECT_EQ(area.cutsOf(curve), outward ? kEndCut : kStartCut);
  }
}

/// The lines of the second image, when the tracker saw the same before.
std::vector<TrackedLine> linesOf(const cv::Mat& image, const cv::Mat& mask = cv::Mat()) {
  LineTracker tracker(LineTrackerParameters{});
  tracker.setMask(mask);
  tracker.process(image, 1000000000);
  return tracker.process(image, 1050000000).frame->lines;
}

TEST(CutFlags, OfTrackedLinesTellWhichEndsTheImageAndTheMaskCut) {
  // The upright sides of a bar go on below the image.
  const cv::Mat bar = rectanglesImage(kSize, {{300.3F, 100.4F, 360.6F, 500.0F, 200.0F}});
  std::vector<TrackedLine> lines = linesOf(bar);
  int upright = 0;
  for (const TrackedLine& line : lines) {
    if (std::abs(line.segment.direction().y()) < 0.9F) {
      EXPECT_EQ(line.cut, 0) << "the top ends at corners";
      continue;
    }
    ++upright;
    EXPECT_EQ(line.cut, line.segment.start.y() > line.segment.end.y() ? kStartCut : kEndCut);
  }
  EXPECT_EQ(upright, 2);

  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
  mask.rowRange(250, 400).setTo(0);
  const cv::Mat boxes = rectanglesImage(
      kSize, {{100.3F, 60.4F, 160.6F, 180.2F, 200.0F}, {300.3F, 60.4F, 360.6F, 330.0F, 200.0F}});
  upright = 0;
  for (const TrackedLine& line : linesOf(boxes, mask)) {
    const auto [top, bottom] = std::minmax(line.segment.start.y(), line.segment.end.y());
    if (bottom - top < 60.0F) continue;
    ++upright;
    const bool ends_before_the_mask = line.segment.middle().x() < 200.0F;
    const int lower_cut = line.segment.start.y() > line.segment.end.y() ? kStartCut : kEndCut;
    EXPECT_EQ(line.cut, ends_before_the_mask ? 0 : lower_cut) << bottom;
  }
  EXPECT_EQ(upright, 4);
}

}  // namespace
}  // namespace tet_line_tracker
