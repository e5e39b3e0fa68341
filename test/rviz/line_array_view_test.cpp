#include "line_array_view.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace tet_line_tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Line lineOf(std::uint64_t id, std::uint32_t age, double x0, double y0, double x1, double y1) {
  Line line;
  line.id = id;
  line.age = age;
  line.start_normalized = {x0, y0};
  line.end_normalized = {x1, y1};
  line.sigma_px = 0.1F;
  return line;
}

PosedLines imageOf(const std::vector<Line>& lines,
                   const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
  auto message = boost::make_shared<LineArray>();
  message->lines = lines;
  return {message, pose};
}

void expectNear(const Eigen::Vector3f& point, const Eigen::Vector3f& expected) {
  EXPECT_LT((point - expected).norm(), 1e-5F) << point.transpose() << " is not " << expected.transpose();
}

void expectSameColour(const Colour& colour, const Colour& expected) {
  EXPECT_EQ(colour.red, expected.red);
  EXPECT_EQ(colour.green, expected.green);
  EXPECT_EQ(colour.blue, expected.blue);
}

TEST(LineArrayView, PutsLinesAtTheDepthInFrontOfWhereTheCameraWas) {
  // The optical axis along x of the fixed frame, x of the image along -y, its y along -z.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.translation() << 5, 6, 7;
  LineArrayStyle style;
  style.depth = 2.0;
  const ShownLines shown = showLines({imageOf({lineOf(1, 1, 0.1, 0.2, -0.3, 0.4)}, pose)}, style);
  ASSERT_EQ(shown.lines.size(), 1U);
  expectNear(shown.lines[0].start, {7.0F, 5.8F, 6.6F});
  expectNear(shown.lines[0].end, {7.0F, 6.6F, 6.2F});
}

TEST(LineArrayView, CountsWhatIsShownTooYoungAndWithoutCalibration) {
  LineArrayStyle style;
  style.min_age = 5;
  const ShownLines shown = showLines(
      {imageOf({lineOf(1, 4, 0, 0, 1, 1), lineOf(2, 5, 0, 0, 1, 1), lineOf(3, 90, 0, 0, kNan, kNan)})},
      style);
  ASSERT_EQ(shown.lines.size(), 1U);
  expectSameColour(shown.lines[0].colour, colourOfTrackAge(5));
  EXPECT_EQ(shown.shown, 1U);
  EXPECT_EQ(shown.hidden, 1U);
  EXPECT_EQ(shown.without_place, 1U);
}

TEST(LineArrayView, ColoursByIdAgeLengthOrSigma) {
  Line line = lineOf(17, 30, 0, 0, 1, 1);
  line.start_px = {10, 10};
  line.end_px = {40, 50};
  line.sigma_px = 0.2F;
  LineArrayStyle style;
  style.alpha = 0.5F;
  style.longest = 100.0;
  style.largest_sigma = 0.8;
  const auto colour = [&](LineArrayStyle::Colouring colouring) {
    style.colouring = colouring;
    return showLines({imageOf({line})}, style).lines.at(0).colour;
  };
  expectSameColour(colour(LineArrayStyle::Colouring::kId), colourOfId(17));
  expectSameColour(colour(LineArrayStyle::Colouring::kAge), colourOfTrackAge(30));
  expectSameColour(colour(LineArrayStyle::Colouring::kLength), colourOnScale(0.5));
  expectSameColour(colour(LineArrayStyle::Colouring::kSigma), colourOnScale(static_cast<double>(0.2F) / 0.8));
  EXPECT_EQ(colour(LineArrayStyle::Colouring::kSigma).alpha, 0.5F);
  line.sigma_px = std::numeric_limits<float>::quiet_NaN();
  expectSameColour(colour(LineArrayStyle::Colouring::kSigma), kUnknownColour);
}

TEST(LineArrayView, WritesIdsOnlyBesideTheLinesOfTheNewestImage) {
  const std::deque<PosedLines> images{imageOf({lineOf(17, 1, 0, 0, 1, 0)}),
                                      imageOf({lineOf(17, 2, 0, 0, 1, 0)})};
  LineArrayStyle style;
  style.trail = 5;
  EXPECT_EQ(showLines(images, style).lines.at(0).label, "");
  style.ids = true;
  const ShownLines shown = showLines(images, style);
  ASSERT_EQ(shown.lines.size(), 3U);
  EXPECT_EQ(shown.lines[0].label, "17");
  EXPECT_EQ(shown.lines[1].label, "");
  EXPECT_EQ(shown.lines[2].label, "");
}

/// Line 1 moves to the right and stays; line 2 is lost after two images.
std::deque<PosedLines> movingLines() {
  return {imageOf({lineOf(1, 1, 0.0, 0.0, 0.0, 1.0), lineOf(2, 1, 0.5, 0.5, 0.6, 0.6)}),
          imageOf({lineOf(1, 2, 0.1, 0.0, 0.1, 1.0), lineOf(2, 2, 0.5, 0.5, 0.6, 0.6)}),
          imageOf({lineOf(1, 3, 0.2, 0.0, 0.2, 1.0)})};
}

TEST(LineArrayView, FollowsTheEndsOfLiveLinesBackFadingOut) {
  LineArrayStyle style;
  style.trail = 2;
  style.alpha = 0.9F;
  const ShownLines shown = showLines(movingLines(), style);
  ASSERT_EQ(shown.lines.size(), 5U);
  EXPECT_EQ(shown.shown, 1U);
  expectNear(shown.lines[1].start, {0.1F, 0.0F, 1.0F});
  expectNear(shown.lines[1].end, {0.2F, 0.0F, 1.0F});
  expectNear(shown.lines[2].start, {0.1F, 1.0F, 1.0F});
  expectNear(shown.lines[2].end, {0.2F, 1.0F, 1.0F});
  expectNear(shown.lines[3].start, {0.0F, 0.0F, 1.0F});
  expectNear(shown.lines[3].end, {0.1F, 0.0F, 1.0F});
  expectSameColour(shown.lines[3].colour, colourOfTrackAge(3));
  EXPECT_FLOAT_EQ(shown.lines[0].colour.alpha, 0.9F);
  EXPECT_FLOAT_EQ(shown.lines[1].colour.alpha, 0.6F);
  EXPECT_FLOAT_EQ(shown.lines[3].colour.alpha, 0.3F);
}

TEST(LineArrayView, TheTrailIsNoLongerThanAskedFor) {
  LineArrayStyle style;
  EXPECT_EQ(showLines(movingLines(), style).lines.size(), 1U);
  style.trail = 1;
  EXPECT_EQ(showLines(movingLines(), style).lines.size(), 3U);
}

TEST(LineArrayView, ALineThatIsNotShownHasNoTrail) {
  LineArrayStyle style;
  style.trail = 5;
  style.min_age = 4;
  EXPECT_TRUE(showLines(movingLines(), style).lines.empty());
}

TEST(LineArrayView, DrawsTheViewOfTheCameraThatFitsTheLines) {
  // f = 100 px, principal point (79.5, 59.5), 160x120 px.
  std::vector<Line> lines;
  for (const std::array<float, 4>& px :
       {std::array<float, 4>{10, 20, 140, 30}, {50, 100, 55, 10}, {150, 5, 90, 110}}) {
    Line line = lineOf(lines.size(), 1, (px[0] - 79.5) / 100, (px[1] - 59.5) / 100, (px[2] - 79.5) / 100,
                       (px[3] - 59.5) / 100);
    line.start_px = {px[0], px[1]};
    line.end_px = {px[2], px[3]};
    lines.push_back(line);
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = 3.0;
  auto message = boost::make_shared<LineArray>();
  message->lines = lines;
  message->width = 160;
  message->height = 120;
  LineArrayStyle style;
  style.depth = 2.0;
  style.frustum = true;
  const ShownLines shown = showLines({{message, pose}}, style);
  ASSERT_EQ(shown.lines.size(), 3U + 8U);
  EXPECT_EQ(shown.shown, 3U);
  expectNear(shown.lines[3].start, {1.4F, -1.2F, 2.0F});
  expectNear(shown.lines[3].end, {4.6F, -1.2F, 2.0F});
  expectNear(shown.lines[4].start, {3.0F, 0.0F, 0.0F});
  expectNear(shown.lines[4].end, {1.4F, -1.2F, 2.0F});
  expectNear(shown.lines[7].start, {4.6F, 1.2F, 2.0F});

  message->lines.pop_back();
  EXPECT_EQ(showLines({{message, pose}}, style).lines.size(), 2U);
}

TEST(LineArrayView, ShowsNothingOfNothing) {
  EXPECT_TRUE(showLines({}, {}).lines.empty());
}

}  // namespace
}  // namespace tet_line_tracker
