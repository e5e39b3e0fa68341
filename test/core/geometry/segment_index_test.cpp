#include "geometry/segment_index.h"

#include <cmath>
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

}  // namespace
}  // namespace tet_line_tracker
