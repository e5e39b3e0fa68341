#include "markers.h"

#include <gtest/gtest.h>

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

using visualization_msgs::Marker;

LineFrame frameOf(std::uint32_t epoch, std::size_t lines, bool calibrated) {
  LineFrame frame;
  frame.epoch = epoch;
  frame.stamp_ns = 5'000'000'000;
  for (std::size_t i = 0; i < lines; ++i) {
    TrackedLine line;
    line.id = 100 + i;
    line.age = 7;
    if (calibrated) {
      line.start_normalized = {0.1, 0.2};
      line.end_normalized = {0.3, 0.6};
    }
    frame.lines.push_back(line);
  }
  return frame;
}

TEST(Markers, LieOnThePlaneInTheColourOfTheAge) {
  MarkerBuilder builder(false);
  const auto array = builder.build(frameOf(0, 2, true), "cam0");
  ASSERT_EQ(array.markers.size(), 2U);
  EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
  const Marker& lines = array.markers[1];
  EXPECT_EQ(lines.type, Marker::LINE_LIST);
  EXPECT_EQ(lines.header.frame_id, "cam0");
  EXPECT_EQ(lines.header.stamp, ros::Time(5));
  ASSERT_EQ(lines.points.size(), 4U);
  EXPECT_EQ(lines.points[1].x, 0.3);
  EXPECT_EQ(lines.points[1].y, 0.6);
  EXPECT_EQ(lines.points[1].z, 1.0);
  ASSERT_EQ(lines.colors.size(), 4U);
  EXPECT_EQ(lines.colors[0].r, colourOfAge(7)[0]);
  EXPECT_EQ(lines.colors[0].a, 1.0F);
}

TEST(Markers, AreAllDeletedWhenAnEpochBeginsAndOnlyThen) {
  MarkerBuilder builder(false);
  builder.build(frameOf(0, 2, true), "cam0");
  EXPECT_EQ(builder.build(frameOf(0, 2, true), "cam0").markers.front().action, Marker::ADD);
  EXPECT_EQ(builder.build(frameOf(1, 2, true), "cam0").markers.front().action, Marker::DELETEALL);
}

TEST(Markers, OfLinesWithoutCalibrationAreDeleted) {
  MarkerBuilder builder(true);
  builder.build(frameOf(0, 2, true), "cam0");
  const auto array = builder.build(frameOf(0, 2, false), "cam0");
  ASSERT_EQ(array.markers.size(), 3U);
  for (const Marker& marker : array.markers) EXPECT_EQ(marker.action, Marker::DELETE);
}

TEST(Markers, NameTheLines) {
  MarkerBuilder builder(true);
  builder.build(frameOf(0, 3, true), "cam0");
  const auto array = builder.build(frameOf(0, 2, true), "cam0");
  int named = 0;
  int deleted = 0;
  for (const Marker& marker : array.markers) {
    if (marker.ns != "ids") continue;
    named += static_cast<int>(marker.action == Marker::ADD);
    deleted += static_cast<int>(marker.action == Marker::DELETE);
  }
  EXPECT_EQ(named, 2);
  EXPECT_EQ(deleted, 1);
  EXPECT_EQ(array.markers.front().text, "100");
  EXPECT_EQ(array.markers.front().pose.position.x, 0.2);
}

}  // namespace
}  // namespace tet_line_tracker
