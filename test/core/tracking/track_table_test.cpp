#include "tracking/track_table.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

LineSegment number(int i) {
  const float y = static_cast<float>(i);
  return {{10.0F, y}, {90.0F, y}};
}

EdgeFit edgeOn(const LineSegment& line, float contrast) {
  EdgeFit edge;
  edge.segment = line;
  edge.contrast = contrast;
  return edge;
}

TEST(TrackTable, NewTracksHaveIdsNeverUsedBeforeAndBeginAtAgeOneWithoutParallax) {
  TrackTable tracks;
  LineFrame frame;
  for (int i = 0; i < 3; ++i) {
    tracks.add(edgeOn(number(i), 5.0F), LineBend{});
    TrackState& state = tracks.state(tracks.size() - 1);
    EXPECT_FALSE(state.lost());
    EXPECT_TRUE(state.start_parallax.isZero() && state.end_parallax.isZero());
    EXPECT_EQ(state.contrast, 5.0F);
    EXPECT_EQ(tracks.line(tracks.size() - 1).age, 1U);
    EXPECT_EQ(tracks.line(tracks.size() - 1).id, static_cast<std::uint64_t>(i));
    // What the next track finds in the buffers of this one must not matter.
    state.start_parallax = state.end_parallax = {3.0F, 4.0F};
    state.loss = LossReason::kFlow;
    tracks.removeLost(frame);
  }
  tracks.add(edgeOn(number(3), 5.0F), LineBend{});
  tracks.clear();
  tracks.add(edgeOn(number(4), 5.0F), LineBend{});
  EXPECT_EQ(tracks.line(0).id, 4U);
}

TEST(TrackTable, RemovesTheLostTracksAndTellsWhichAndWhy) {
  TrackTable tracks;
  for (int i = 0; i < 6; ++i) tracks.add(edgeOn(number(i), static_cast<float>(i)), LineBend{});
  tracks.state(0).loss = LossReason::kAngle;
  tracks.state(2).loss = LossReason::kMask;
  tracks.state(3).loss = LossReason::kAngle;
  LineFrame frame;
  tracks.removeLost(frame);
  const FrameStatistics& statistics = frame.statistics;
  EXPECT_EQ(statistics.lostFor(LossReason::kAngle), 2U);
  EXPECT_EQ(statistics.lostFor(LossReason::kMask), 1U);
  EXPECT_EQ(statistics.lostFor(LossReason::kFlow), 0U);
  EXPECT_EQ(statistics.tracks_kept, 3U);
  ASSERT_EQ(frame.lost.size(), 3U);
  EXPECT_EQ(frame.lost[0].id, 0U);
  EXPECT_EQ(frame.lost[1].id, 2U);
  EXPECT_EQ(frame.lost[2].id, 3U);
  EXPECT_EQ(frame.lost[1].reason, LossReason::kMask);
  EXPECT_EQ(frame.lost[2].reason, LossReason::kAngle);
}

TEST(TrackTable, TheOtherTracksKeepTheirOrderAndTheirState) {
  TrackTable tracks;
  for (int i = 0; i < 6; ++i) tracks.add(edgeOn(number(i), static_cast<float>(i)), LineBend{});
  for (const std::size_t i : {0U, 2U, 3U}) tracks.state(i).loss = LossReason::kAngle;
  LineFrame frame;
  tracks.removeLost(frame);
  ASSERT_EQ(tracks.size(), 3U);
  const int kept[] = {1, 4, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(tracks.line(i).id, static_cast<std::uint64_t>(kept[i]));
    EXPECT_EQ(tracks.line(i).segment.start, number(kept[i]).start);
    EXPECT_EQ(tracks.state(i).contrast, static_cast<float>(kept[i]));
    EXPECT_FALSE(tracks.state(i).lost());
  }
}

TEST(TrackTable, ALineThatGrewHasTheParallaxOfItsNewEnds) {
  TrackTable tracks;
  // Turned about its middle by parallax: 1 px at each end of 80 px.
  tracks.add(edgeOn({{10.0F, 51.0F}, {90.0F, 49.0F}}, 5.0F), LineBend{});
  TrackState& state = tracks.state(0);
  state.rotated = {{10.0F, 50.0F}, {90.0F, 50.0F}};
  state.template_due = false;
  const LineSegment grown{{-30.0F, 52.0F}, {90.0F, 49.0F}};
  state.setGrown(tracks.line(0).segment, grown);
  tracks.line(0).segment = grown;
  EXPECT_TRUE(state.template_due);
  tracks.predictParallax();
  EXPECT_NEAR(state.start_parallax.y(), 0.8F * 2.0F, 0.01F);
  EXPECT_NEAR(state.end_parallax.y(), -0.8F, 0.01F);
}

TEST(TrackTable, CountsTheCellsThatABentLineCrosses) {
  TrackTable tracks;
  EdgeFit edge;
  edge.segment = {{0.0F, 90.0F}, {639.0F, 90.0F}};
  tracks.add(edge, LineBend{{60.0F}});
  // Eight cells along the chord; the curve rises into the row above in six columns, two of which show both
  // rows.
  EXPECT_FLOAT_EQ(48.0F * tracks.coverage({640, 480}), 10.0F);
}

}  // namespace
}  // namespace tet_line_tracker
