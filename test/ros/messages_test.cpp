#include "messages.h"

#include <gtest/gtest.h>
#include <cmath>

namespace tet_line_tracker {
namespace {

LineFrame exampleFrame() {
  LineFrame frame;
  frame.stamp_ns = 1403715273262142976;
  frame.epoch = 3;
  frame.image_count = 17;
  frame.width = 752;
  frame.height = 480;
  frame.detected = true;
  TrackedLine line;
  line.id = 1ULL << 40;
  line.age = 5;
  line.segment = {{10.5F, 20.25F}, {110.0F, 21.0F}};
  line.start_normalized = {-0.5, 0.25};
  line.end_normalized = {0.125, -0.75};
  line.sigma_px = 0.3F;
  line.residual = 0.01F;
  frame.lines = {line, TrackedLine{}};
  return frame;
}

TEST(Messages, CarryEveryFieldOfALine) {
  const LineArray message = toLineArray(exampleFrame(), "cam0", 9);
  EXPECT_EQ(message.header.seq, 9U);
  EXPECT_EQ(message.header.frame_id, "cam0");
  EXPECT_EQ(message.header.stamp, ros::Time(1403715273, 262142976));
  EXPECT_EQ(message.epoch, 3U);
  EXPECT_EQ(message.image_count, 17U);
  EXPECT_EQ(message.width, 752U);
  EXPECT_EQ(message.height, 480U);
  EXPECT_TRUE(message.detected);
  ASSERT_EQ(message.lines.size(), 2U);
  const Line& line = message.lines[0];
  EXPECT_EQ(line.id, 1ULL << 40);
  EXPECT_EQ(line.age, 5U);
  EXPECT_EQ(line.start_px[0], 10.5F);
  EXPECT_EQ(line.start_px[1], 20.25F);
  EXPECT_EQ(line.end_px[0], 110.0F);
  EXPECT_EQ(line.end_px[1], 21.0F);
  EXPECT_EQ(line.start_normalized[0], -0.5);
  EXPECT_EQ(line.start_normalized[1], 0.25);
  EXPECT_EQ(line.end_normalized[0], 0.125);
  EXPECT_EQ(line.end_normalized[1], -0.75);
  EXPECT_EQ(line.sigma_px, 0.3F);
  EXPECT_EQ(line.residual, 0.01F);
  EXPECT_TRUE(std::isnan(message.lines[1].start_normalized[0]));
}

TEST(Messages, GiveEachReasonOfALossItsField) {
  LineFrame frame = exampleFrame();
  for (std::size_t i = 0; i < frame.statistics.lost.size(); ++i) {
    frame.statistics.lost[i] = static_cast<std::uint32_t>(100 + i);
  }
  frame.lost = {{1ULL << 40, LossReason::kFlow}, {1ULL << 41, LossReason::kDuplicate}};
  frame.statistics.dropped_late = 7;
  frame.statistics.lines_cut = 11;
  frame.statistics.lines_left_out = 12;
  frame.statistics.total_ms = 2.5;
  frame.statistics.imu_time_offset = -0.25;
  const TrackingStatistics message = toTrackingStatistics(frame, "cam0", 0, 4);
  const std::vector<std::uint32_t> lost{
      message.lost_flow,    message.lost_residual, message.lost_length_ratio, message.lost_angle,
      message.lost_support, message.lost_border,   message.lost_short,        message.lost_field_of_view,
      message.lost_mask,    message.lost_depth,    message.lost_edge_jump,    message.lost_duplicate};
  ASSERT_EQ(lost.size(), frame.statistics.lost.size());
  for (std::size_t i = 0; i < lost.size(); ++i) EXPECT_EQ(lost[i], 100 + i);
  EXPECT_EQ(message.lost_ids, (std::vector<std::uint64_t>{1ULL << 40, 1ULL << 41}));
  EXPECT_EQ(message.lost_reasons, (std::vector<std::uint8_t>{0, static_cast<std::uint8_t>(lost.size() - 1)}));
  EXPECT_EQ(message.dropped_late, 7U);
  EXPECT_EQ(message.lines_cut, 11U);
  EXPECT_EQ(message.lines_left_out, 12U);
  EXPECT_EQ(message.dropped_queue, 4U);
  EXPECT_EQ(message.total_ms, 2.5F);
  EXPECT_EQ(message.imu_time_offset, -0.25F);
  EXPECT_EQ(message.epoch, 3U);
}

}  // namespace
}  // namespace tet_line_tracker
