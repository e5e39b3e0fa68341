#include "line3d_array_view.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

Line3D lineAt(std::uint64_t id, double height, float sigma, bool finished) {
  Line3D line;
  line.id = id;
  line.start.x = 1.0;
  line.start.z = height - 0.5;
  line.end.y = 2.0;
  line.end.z = height + 0.5;
  line.sigma_start = 0.5F * sigma;
  line.sigma_end = sigma;
  line.views = 10;
  line.finished = finished;
  return line;
}

Line3DArray mapOf(const std::vector<Line3D>& lines) {
  Line3DArray map;
  map.lines = lines;
  return map;
}

void expectSameColour(const Colour& colour, const Colour& expected) {
  EXPECT_EQ(colour.red, expected.red);
  EXPECT_EQ(colour.green, expected.green);
  EXPECT_EQ(colour.blue, expected.blue);
}

TEST(Line3DArrayView, DrawsLinesWhereTheyAreColouredByTheirLargerSigma) {
  Line3DArrayStyle style;
  style.largest_sigma = 0.5;
  style.alpha = 0.25F;
  const ShownLines shown = showMap(mapOf({lineAt(1, 3.0, 0.125F, false)}), style);
  ASSERT_EQ(shown.lines.size(), 1U);
  EXPECT_EQ(shown.lines[0].start, Eigen::Vector3f(1.0F, 0.0F, 2.5F));
  EXPECT_EQ(shown.lines[0].end, Eigen::Vector3f(0.0F, 2.0F, 3.5F));
  expectSameColour(shown.lines[0].colour, colourOnScale(0.25));
  EXPECT_EQ(shown.lines[0].colour.alpha, 0.25F);
  EXPECT_EQ(shown.lines[0].label, "");
  style.ids = true;
  EXPECT_EQ(showMap(mapOf({lineAt(77, 3.0, 0.1F, false)}), style).lines.at(0).label, "77");
}

TEST(Line3DArrayView, ColoursByHeightBetweenTheBoundsOfTheMapOrThoseGiven) {
  const Line3DArray map =
      mapOf({lineAt(1, 1.0, 0.1F, true), lineAt(2, 2.0, 0.1F, true), lineAt(3, 5.0, 0.1F, false)});
  Line3DArrayStyle style;
  style.colouring = Line3DArrayStyle::Colouring::kHeight;
  style.alpha = 0.5F;
  ShownLines shown = showMap(map, style);
  ASSERT_EQ(shown.lines.size(), 3U);
  expectSameColour(shown.lines[0].colour, colourOnScale(0.0));
  expectSameColour(shown.lines[1].colour, colourOnScale(0.25));
  expectSameColour(shown.lines[2].colour, colourOnScale(1.0));
  EXPECT_EQ(shown.lines[1].colour.alpha, 0.5F);

  style.height_bounds_of_map = false;
  style.lowest = 0.0;
  style.highest = 4.0;
  shown = showMap(map, style);
  expectSameColour(shown.lines[0].colour, colourOnScale(0.25));
  expectSameColour(shown.lines[2].colour, colourOnScale(1.0));
  EXPECT_TRUE(showMap(mapOf({}), style).lines.empty());
}

TEST(Line3DArrayView, TellsLiveLinesFromFinishedOnes) {
  const Line3DArray map = mapOf({lineAt(1, 1.0, 0.1F, true), lineAt(2, 1.0, 0.1F, false)});
  Line3DArrayStyle style;
  style.colouring = Line3DArrayStyle::Colouring::kState;
  const ShownLines both = showMap(map, style);
  ASSERT_EQ(both.lines.size(), 2U);
  EXPECT_GT(both.lines[0].colour.blue, both.lines[0].colour.green);
  EXPECT_GT(both.lines[1].colour.green, both.lines[1].colour.blue);

  style.ids = true;
  style.live = false;
  const ShownLines finished = showMap(map, style);
  ASSERT_EQ(finished.lines.size(), 1U);
  EXPECT_EQ(finished.lines[0].label, "1");
  EXPECT_EQ(finished.hidden, 1U);
  style.live = true;
  style.finished = false;
  EXPECT_EQ(showMap(map, style).lines.at(0).label, "2");
}

TEST(Line3DArrayView, LeavesOutWhatIsUncertainOrRarelySeen) {
  Line3DArray map =
      mapOf({lineAt(1, 1.0, 0.1F, true), lineAt(2, 1.0, 0.3F, true), lineAt(3, 1.0, 0.1F, true)});
  map.lines[2].views = 3;
  Line3DArrayStyle style;
  style.max_sigma = 0.2;
  style.min_views = 4;
  style.ids = true;
  const ShownLines shown = showMap(map, style);
  ASSERT_EQ(shown.lines.size(), 1U);
  EXPECT_EQ(shown.lines[0].label, "1");
  EXPECT_EQ(shown.shown, 1U);
  EXPECT_EQ(shown.hidden, 2U);
}

TEST(Line3DArrayView, DrawsNothingThatIsNotANumberAndCountsIt) {
  Line3DArray map = mapOf({lineAt(1, 1.0, 0.1F, true), lineAt(2, 1.0, 0.1F, true)});
  map.lines[0].end.y = std::numeric_limits<double>::quiet_NaN();
  map.lines[1].sigma_end = std::numeric_limits<float>::quiet_NaN();
  const ShownLines shown = showMap(map, {});
  ASSERT_EQ(shown.lines.size(), 1U);
  EXPECT_EQ(shown.without_place, 1U);
  expectSameColour(shown.lines[0].colour, kUnknownColour);
}

}  // namespace
}  // namespace tet_line_tracker
