#include "markers.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tet_line_tracker/camera/lens_bend.h"
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

TEST(Markers, RunAlongTheWholeEdgeThatTheLensBends) {
  CameraCalibration calibration;
  calibration.model = "plumb_bob";
  calibration.width = 752;
  calibration.height = 480;
  calibration.fx = calibration.fy = 458.0;
  calibration.cx = 367.0;
  calibration.cy = 248.0;
  calibration.distortion = {-0.28, 0.07, 0.0, 0.0};
  const auto camera = makeCameraModel(calibration);
  LineFrame frame = frameOf(0, 1, true);
  TrackedLine& line = frame.lines[0];
  line.segment = {{100.0F, 60.0F}, {650.0F, 60.0F}};
  line.start_normalized = *camera->normalize(line.segment.start.cast<double>());
  line.end_normalized = *camera->normalize(line.segment.end.cast<double>());
  const auto markers = MarkerBuilder(false).build(frame, "cam0").markers;
  ASSERT_EQ(markers[1].points.size(), 2U);
  const auto& from = markers[1].points[0];
  const auto& to = markers[1].points[1];
  const LineCurve curve = LensBend(camera, 752, 480).curve(line.segment);
  ASSERT_GT(std::abs(curve.bend.offset(0.5F)), 8.0F);
  for (const float fraction : {0.2F, 0.5F, 0.7F}) {
    const Eigen::Vector2d seen = *camera->normalize(curve.at(fraction).cast<double>());
    const double across = (seen.x() - from.x) * (to.y - from.y) - (seen.y() - from.y) * (to.x - from.x);
    EXPECT_NEAR(458.0 * across / std::hypot(to.x - from.x, to.y - from.y), 0.0, 0.1);
  }
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
