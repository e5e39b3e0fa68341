#include "../../src/tools/line_bag.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/TrackingStatistics.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

constexpr char kLines[] = "/line_tracker/lines";

/// The losses that are read from a bag of one image, whose statistics say this of them.
std::vector<LostLine> lostOf(const std::vector<std::uint64_t>& ids,
                             const std::vector<std::uint8_t>& reasons) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "lines.bag").string();
  const ros::Time stamp(5);
  LineArray lines;
  lines.header.stamp = stamp;
  TrackingStatistics statistics;
  statistics.header.stamp = stamp;
  statistics.lost_ids = ids;
  statistics.lost_reasons = reasons;
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.write(kLines, stamp, lines);
    bag.write("/line_tracker/statistics", stamp, statistics);
  }
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  return readLines(bag, kLines).frames.at(0).lost;
}

TEST(LineBag, GivesTheReasonOfEachLostLine) {
  const std::vector<LostLine> lost = lostOf({4, 9}, {0, 11});
  ASSERT_EQ(lost.size(), 2U);
  EXPECT_EQ(lost[0].id, 4U);
  EXPECT_EQ(lost[0].reason, LossReason::kFlow);
  EXPECT_EQ(lost[1].id, 9U);
  EXPECT_EQ(lost[1].reason, LossReason::kDuplicate);
}

TEST(LineBag, LeavesOutWhatNoTrackerWrites) {
  const std::vector<LostLine> unknown = lostOf({4, 9}, {12, 8});
  ASSERT_EQ(unknown.size(), 1U) << "a reason that there is not";
  EXPECT_EQ(unknown[0].id, 9U);
  EXPECT_EQ(lostOf(std::vector<std::uint64_t>(1000, 4), {5}).size(), 1U) << "more ids than reasons";
  EXPECT_EQ(lostOf({4}, {5, 6, 7}).size(), 1U);
}

}  // namespace
}  // namespace tet_line_tracker
