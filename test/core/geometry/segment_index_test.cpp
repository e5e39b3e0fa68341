#include "geometry/segment_index.h"

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

LineSegment along(float angle, float offset, float begin, float end) {
  const Eigen::Vector2f direction(std::cos(angle), std::sin(angle));
  const Eigen::Vector2f foot =
      Eigen::Vector2f(300.0F, 200.0F) + offset * Eigen::Vector2f(-direction.y(), direction.x());
  return {foot + begin * direction, foot + end * direction};
}

TEST(SameEdge, IsParallelNearAndSideBySide) {
  const DuplicateCriteria limits{0.1F, 4.0F, 0.2F};
  const LineSegment line = along(0.3F, 0.0F, 0.0F, 100.0F);
  EXPECT_TRUE(areDuplicates(line, along(0.33F, 2.0F, 20.0F, 70.0F), limits));
  EXPECT_FALSE(areDuplicates(line, along(0.45F, 0.0F, 20.0F, 70.0F), limits)) << "turned";
  EXPECT_FALSE(areDuplicates(line, along(0.3F, 6.0F, 20.0F, 70.0F), limits)) << "beside";
  EXPECT_FALSE(areDuplicates(line, along(0.3F, 0.0F, 110.0F, 170.0F), limits)) << "behind";
  const LineSegment back = along(0.3F, 1.0F, 70.0F, 20.0F);
  EXPECT_FALSE(areDuplicates(line, back, limits)) << "the other side of a dark line";
}

TEST(SameEdge, AnIndexFindsWhatEveryPairWouldShow) {
  std::mt19937 generator(3);
  const auto uniform = [&generator](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(generator);
  };
  const DuplicateCriteria limits{0.2F, 4.0F, 0.2F};
  SegmentIndex index(limits);
  for (int round = 0; round < 2; ++round) {
    index.clear();
    std::vector<LineSegment> all;
    int held = 0;
    for (int i = 0; i < 2000; ++i) {
      const float begin = uniform(-100.0F, 100.0F);
      const LineSegment line =
          along(uniform(0.0F, 6.2832F), uniform(-20.0F, 20.0F), begin, begin + uniform(20.0F, 80.0F));
      bool any = false;
      for (const LineSegment& other : all) any |= areDuplicates(line, other, limits);
      EXPECT_EQ(index.containsDuplicateOf(line), any) << i;
      held += any ? 1 : 0;
      index.add(line);
      all.push_back(line);
    }
    EXPECT_GT(held, 500);
    EXPECT_LT(held, 1990);
  }
}

TEST(SameEdge, FollowsTheBendOfALine) {
  const DuplicateCriteria limits{0.05F, 1.5F, 0.3F};
  // 8 px above its chord in the middle, on screen; at a quarter 6 px.
  const LineCurve bent({{100.0F, 300.0F}, {500.0F, 300.0F}}, LineBend{{32.0F}});
  const LineSegment on_curve{{180.0F, 294.9F}, {220.0F, 293.3F}};
  EXPECT_TRUE(areDuplicates(bent, on_curve, limits));
  EXPECT_TRUE(areDuplicates(on_curve, bent, limits));
  EXPECT_FALSE(areDuplicates(bent, LineSegment{{180.0F, 300.0F}, {220.0F, 300.0F}}, limits))
      << "on the chord";
  // At the start the curve rises by 0.08: a piece in the direction of the chord is turned.
  EXPECT_TRUE(areDuplicates(bent, LineSegment{{105.0F, 299.6F}, {145.0F, 296.8F}}, limits));
  EXPECT_FALSE(areDuplicates(bent, LineSegment{{105.0F, 298.2F}, {145.0F, 298.9F}}, limits));
}

TEST(SameEdge, AnIndexFindsPiecesOfABentLineThatAreTurnedAgainstItsChord) {
  const DuplicateCriteria limits;
  // The curve leaves its chord by 30 px: near its ends it is 0.18 rad steeper than the chord.
  const LineCurve bent({{100.0F, 300.0F}, {700.0F, 300.0F}}, LineBend{{120.0F}});
  const LineCurve piece(LineSegment{bent.at(0.02F), bent.at(0.1F)});
  ASSERT_TRUE(areDuplicates(bent, piece, limits));
  SegmentIndex index(limits);
  index.add(bent);
  EXPECT_TRUE(index.containsDuplicateOf(piece));
  index.clear();
  index.add(piece);
  EXPECT_TRUE(index.containsDuplicateOf(bent));
  index.clear();
  EXPECT_FALSE(index.containsDuplicateOf(bent));
}

TEST(LineCurve, IsClippedWhereTheCurveLeavesTheBounds) {
  const ImageBounds bounds = ImageBounds::ofImage(640, 480, 2.0F);
  // The chord leaves the image at the bottom; the curve, 8 px above it in the middle, does so later.
  const LineCurve bent({{100.0F, 470.0F}, {500.0F, 482.0F}}, LineBend{{32.0F}});
  const std::optional<LineSegment> clipped = clip(bent, bounds);
  ASSERT_TRUE(clipped);
  EXPECT_EQ(clipped->start, bent.chord.start);
  EXPECT_GT(clipped->end.x(), clip(bent.chord, bounds)->end.x() + 30.0F);
  EXPECT_NEAR(clipped->end.y(), 477.0F, 0.05F);
  EXPECT_NEAR(bent.distance(clipped->end), 0.0F, 0.01F);
  EXPECT_FALSE(clip(LineCurve({{100.0F, 520.0F}, {500.0F, 520.0F}}, LineBend{{32.0F}}), bounds));
}

}  // namespace
}  // namespace tet_line_tracker
