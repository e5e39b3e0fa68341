#include "evaluation/map_accuracy.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

const std::vector<TrueEdge> kEdges{
    {{0, 0, 0}, {2, 0, 0}}, {{0, 0.05, 0}, {2, 0.05, 0}}, {{0, 0, 0}, {0, 0, 3}}};

TEST(MapAccuracy, MeasuresDistanceAndDirectionToTheNearestEdge) {
  // 1 cm off at the start, 3 cm at the end: the mean of the five points is 2 cm.
  const auto error = errorOf({{0.5, 0, 0.01}, {1.5, 0, 0.03}, 2.0, 0.005}, kEdges);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->edge, 0U);
  EXPECT_NEAR(error->across_m, 0.02, 1e-9);
  EXPECT_NEAR(error->direction_rad, std::atan(0.02), 1e-9);
  const auto other = errorOf({{1.5, 0.06, 0}, {0.5, 0.06, 0}, 2.0, 0.005}, kEdges);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->edge, 1U);
  EXPECT_NEAR(other->across_m, 0.01, 1e-9);
}

TEST(MapAccuracy, FindsNoEdgeWhereNoneRunsAlong) {
  EXPECT_FALSE(errorOf({{0.5, 0, 0.2}, {1.5, 0, 0.2}, 2.0, 0.005}, kEdges)) << "too far";
  EXPECT_FALSE(errorOf({{0.5, 0, 0}, {0.9, 0.2, 0}, 2.0, 0.005}, kEdges)) << "too oblique";
  EXPECT_FALSE(errorOf({{3.0, 0, 0}, {4.0, 0, 0}, 2.0, 0.005}, kEdges)) << "beyond the end";
  EXPECT_TRUE(errorOf({{1.0, 0, 0}, {2.5, 0, 0}, 2.0, 0.005}, kEdges)) << "most of it beside the edge";
}

TEST(MapAccuracy, CountsALineWithoutEdgeAsInfinitelyWrong) {
  const LineInSpace good{{0.5, 0, 0.01}, {1.5, 0, 0.01}, 2.0, 0.005};
  const LineInSpace bad{{0.5, 5, 0}, {1.5, 5, 0}, 2.0, 0.005};
  const MapAccuracy one = measureMap({good, good, bad}, kEdges);
  EXPECT_EQ(one.lines, 3U);
  EXPECT_EQ(one.without_edge, 1U);
  EXPECT_EQ(one.edges, 1U);
  EXPECT_NEAR(one.across_median, 0.01, 1e-9);
  EXPECT_NEAR(one.claim_median, 2.0, 1e-6);
  EXPECT_TRUE(std::isinf(one.across_p90));
  EXPECT_TRUE(std::isinf(measureMap({good, bad, bad}, kEdges).direction_median));
}

}  // namespace
}  // namespace tet_line_tracker
