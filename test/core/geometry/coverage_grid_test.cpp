#include "geometry/coverage_grid.h"

#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

// Cells of 80 x 80 px, eight in a row, six rows.
constexpr int kWidth = 640;
constexpr int kHeight = 480;

float coverageOf(const std::vector<LineSegment>& lines) {
  CoverageGrid grid(kWidth, kHeight);
  for (const LineSegment& line : lines) grid.add(line);
  return 48.0F * grid.coverage();
}

TEST(CoverageGrid, CountsTheCellsThatALineCrosses) {
  EXPECT_FLOAT_EQ(coverageOf({}), 0.0F);
  EXPECT_FLOAT_EQ(coverageOf({{{10.0F, 10.0F}, {70.0F, 60.0F}}}), 1.0F);
  EXPECT_FLOAT_EQ(coverageOf({{{0.0F, 40.0F}, {639.0F, 40.0F}}}), 8.0F);
  EXPECT_FLOAT_EQ(coverageOf({{{40.0F, 479.0F}, {40.0F, 0.0F}}}), 6.0F);
  EXPECT_FLOAT_EQ(coverageOf({{{0.0F, 470.0F}, {639.0F, 470.0F}}}), 8.0F);
}

TEST(CoverageGrid, CountsTheCellsAlongTheCurveOfABentLine) {
  CoverageGrid grid(kWidth, kHeight);
  // 15 px up in the middle: into the row above for six columns, of which two show both rows.
  grid.add(LineCurve({{0.0F, 90.0F}, {639.0F, 90.0F}}, LineBend{{60.0F}}));
  EXPECT_FLOAT_EQ(48.0F * grid.coverage(), 10.0F);
}

TEST(CoverageGrid, CountsACellOnceHoweverManyLinesCrossIt) {
  EXPECT_FLOAT_EQ(coverageOf({{{10.0F, 10.0F}, {150.0F, 10.0F}}, {{70.0F, 20.0F}, {10.0F, 20.0F}}}), 2.0F);
}

TEST(CoverageGrid, IsOneWhenEveryRowIsCrossed) {
  std::vector<LineSegment> rows;
  for (int row = 0; row < 6; ++row) {
    const float y = 80.0F * static_cast<float>(row) + 40.0F;
    rows.push_back({{0.0F, y}, {639.0F, y}});
  }
  EXPECT_FLOAT_EQ(coverageOf(rows), 48.0F);
}

}  // namespace
}  // namespace tet_line_tracker
