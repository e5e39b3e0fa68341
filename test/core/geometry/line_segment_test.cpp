#include "tet_line_tracker/geometry/line_segment.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(LineSegment, TheDistanceIsPositiveToTheLeftOnScreen) {
  const LineSegment right{{10.0F, 50.0F}, {30.0F, 50.0F}};  // y points down: up on screen is smaller y
  EXPECT_FLOAT_EQ(right.distance({15.0F, 45.0F}), 5.0F);
  EXPECT_FLOAT_EQ(right.distance({100.0F, 52.0F}), -2.0F);
  EXPECT_FLOAT_EQ(right.along({15.0F, 45.0F}), 5.0F);
}

TEST(LineSegment, TheAngleRespectsTheRolesOfStartAndEnd) {
  const LineSegment a{{0.0F, 0.0F}, {10.0F, 0.0F}};
  const LineSegment b{{0.0F, 0.0F}, {0.0F, 4.0F}};
  const LineSegment reversed{{10.0F, 0.0F}, {0.0F, 0.0F}};
  EXPECT_NEAR(angleBetween(a, b), M_PI / 2, 1e-6);
  EXPECT_NEAR(angleBetween(b, a), M_PI / 2, 1e-6) << "in either order";
  EXPECT_NEAR(angleBetween(a, reversed), M_PI, 1e-6);
}

TEST(LineSegment, TheOverlapIsTheShareBesideTheOther) {
  const LineSegment longer{{0.0F, 0.0F}, {100.0F, 0.0F}};
  EXPECT_FLOAT_EQ(overlap({{10.0F, 3.0F}, {20.0F, 3.0F}}, longer), 1.0F);
  EXPECT_FLOAT_EQ(overlap({{90.0F, 3.0F}, {130.0F, 3.0F}}, longer), 0.25F);
  EXPECT_FLOAT_EQ(overlap({{130.0F, 3.0F}, {90.0F, 3.0F}}, longer), 0.25F);
  EXPECT_FLOAT_EQ(overlap({{110.0F, 0.0F}, {130.0F, 0.0F}}, longer), 0.0F);
}

TEST(LineSegment, ClippingKeepsTheRolesAndTheDirection) {
  const ImageBounds bounds = ImageBounds::ofImage(101, 51);
  const auto through = clip({{-10.0F, 25.0F}, {110.0F, 25.0F}}, bounds);
  ASSERT_TRUE(through);
  EXPECT_EQ(through->start, Eigen::Vector2f(0.0F, 25.0F));
  EXPECT_EQ(through->end, Eigen::Vector2f(100.0F, 25.0F));
  const auto inside = clip({{20.0F, 10.0F}, {30.0F, 40.0F}}, bounds);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->start, Eigen::Vector2f(20.0F, 10.0F));
  const auto slanted = clip({{50.0F, 40.0F}, {80.0F, 70.0F}}, bounds);
  ASSERT_TRUE(slanted);
  EXPECT_NEAR(slanted->end.x(), 60.0F, 1e-4F);
  EXPECT_NEAR(slanted->end.y(), 50.0F, 1e-4F);
  EXPECT_FALSE(clip({{-10.0F, 5.0F}, {-1.0F, 20.0F}}, bounds));
  EXPECT_FALSE(clip({{-10.0F, 5.0F}, {5.0F, -10.0F}}, bounds));
}

}  // namespace
}  // namespace tet_line_tracker
