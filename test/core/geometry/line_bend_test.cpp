#include "tet_line_tracker/geometry/line_bend.h"

#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

const ImageBounds kBounds{0.0F, 0.0F, 751.0F, 479.0F};

LineCurve bent(const Eigen::Vector2f& start, const Eigen::Vector2f& end) {
  LineBend bend;
  bend.c[0] = 8.0F;
  return {LineSegment{start, end}, bend};
}

TEST(Clip, EndsACurveWhereItLeavesTheImage) {
  const std::optional<LineSegment> inside = clip(bent({-100, 200}, {300, 200}), kBounds);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->start.x(), 0.0F, 0.01F);
  EXPECT_NEAR(std::abs(inside->start.y() - 200.0F), 8.0F * 0.25F * 0.75F, 0.01F);
  EXPECT_EQ(inside->end, Eigen::Vector2f(300, 200));
}

TEST(Clip, EndsACurveThatIsExpectedFarAway) {
  // One end beside the camera: prediction puts it this far out. Fractions of floats differ by 6e-8 at least.
  for (const float far : {1e5F, 1e6F, 1e9F, 1e30F}) {
    const std::optional<LineSegment> inside = clip(bent({-far, 0.3F * far}, {148, 373}), kBounds);
    ASSERT_TRUE(inside) << far;
    EXPECT_TRUE(kBounds.contains(inside->start)) << inside->start.transpose();
    EXPECT_EQ(inside->end, Eigen::Vector2f(148, 373));
  }
}

TEST(Clip, OfACurveThatEndsNowhereEnds) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float nowhere : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    const std::optional<LineSegment> inside = clip(bent({nowhere, nowhere}, {148, 373}), kBounds);
    if (inside) {
      EXPECT_EQ(inside->end, Eigen::Vector2f(148, 373));
    }
  }
}

}  // namespace
}  // namespace tet_line_tracker
