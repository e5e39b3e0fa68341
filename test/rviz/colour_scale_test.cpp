#include "colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

float distance(const Colour& left, const Colour& right) {
  return std::hypot(left.red - right.red, left.green - right.green, left.blue - right.blue);
}

TEST(ColourScale, GoesFromBlueOverGreenAndYellowToRed) {
  const Colour low = colourOnScale(0.0);
  EXPECT_GT(low.blue, low.red + 0.5F);
  const Colour third = colourOnScale(1.0 / 3.0);
  EXPECT_GT(third.green, third.red + 0.5F);
  EXPECT_GT(third.green, third.blue + 0.5F);
  const Colour two_thirds = colourOnScale(2.0 / 3.0);
  EXPECT_GT(two_thirds.red, 0.9F);
  EXPECT_GT(two_thirds.green, two_thirds.blue + 0.5F);
  const Colour high = colourOnScale(1.0);
  EXPECT_GT(high.red, high.green + 0.5F);
}

TEST(ColourScale, HasNoJumps) {
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LT(distance(colourOnScale(0.001 * i), colourOnScale(0.001 * (i + 1))), 0.01F) << i;
  }
}

TEST(ColourScale, CountsValuesOutsideAsTheNearerEnd) {
  EXPECT_EQ(distance(colourOnScale(-3.0), colourOnScale(0.0)), 0.0F);
  EXPECT_EQ(distance(colourOnScale(7.0), colourOnScale(1.0)), 0.0F);
  EXPECT_EQ(distance(colourOnScale(std::numeric_limits<double>::infinity()), colourOnScale(1.0)), 0.0F);
}

TEST(ColourScale, ShowsWhatIsNotKnownInGray) {
  EXPECT_EQ(distance(colourOnScale(kNan), kUnknownColour), 0.0F);
  EXPECT_TRUE(std::isnan(placeBetween(0.0, 1.0, kNan)));
}

TEST(ColourScale, PlacesAValueBetweenItsBounds) {
  EXPECT_DOUBLE_EQ(placeBetween(2.0, 4.0, 3.5), 0.75);
  EXPECT_DOUBLE_EQ(placeBetween(2.0, 2.0, 2.0), 0.5);
}

TEST(ColourScale, GivesAgesTheColoursOfTheDebugImage) {
  for (const std::uint32_t age : {1U, 7U, 100U}) {
    const std::array<float, 3> expected = colourOfAge(age);
    const Colour colour = colourOfTrackAge(age);
    EXPECT_EQ(colour.red, expected[0]);
    EXPECT_EQ(colour.green, expected[1]);
    EXPECT_EQ(colour.blue, expected[2]);
  }
}

TEST(ColourScale, TellsIdsThatFollowEachOtherApart) {
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{1000}, std::uint64_t{1} << 40U}) {
    for (std::uint64_t id = first; id < first + 6; ++id) {
      EXPECT_EQ(distance(colourOfId(id), colourOfId(id)), 0.0F);
      for (std::uint64_t other = first; other < id; ++other) {
        EXPECT_GT(distance(colourOfId(id), colourOfId(other)), 0.15F) << id << " and " << other;
      }
    }
  }
}

TEST(ColourScale, GivesEveryIdABrightColour) {
  for (std::uint64_t id = 0; id < 100; ++id) {
    const Colour colour = colourOfId(id);
    EXPECT_EQ(std::max({colour.red, colour.green, colour.blue}), 1.0F) << id;
  }
}

}  // namespace
}  // namespace tet_line_tracker
