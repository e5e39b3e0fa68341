#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include "pl_vins_contract.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

using Rule = ContractFault::Rule;

struct Stream {
  std::vector<ros::Time> points;
  std::vector<sensor_msgs::PointCloud> lines;
};

/// 30 pairs of messages with 6 lines each, of which one leaves and another comes every 5 messages.
Stream goodStream() {
  Stream stream;
  for (int i = 0; i < 30; ++i) {
    sensor_msgs::PointCloud cloud;
    cloud.header.stamp = ros::Time(10.0 + 0.1 * i);
    cloud.header.frame_id = "world";
    cloud.channels.resize(3);
    for (int k = 0; k < 6 && i != 20; ++k) {
      const int id = i < 20 ? k + i / 5 : 100 + k;
      geometry_msgs::Point32 start;
      start.x = static_cast<float>(0.1 * k + 0.002 * i);
      start.y = -0.3F;
      start.z = 1.0F;
      cloud.points.push_back(start);
      cloud.channels[0].values.push_back(static_cast<float>(id));
      cloud.channels[1].values.push_back(static_cast<float>(0.1 * k + 0.05));
      cloud.channels[2].values.push_back(0.3F);
    }
    stream.points.push_back(cloud.header.stamp);
    stream.lines.push_back(cloud);
  }
  return stream;
}

PlVinsContract judged(const Stream& stream) {
  PlVinsContract contract;
  for (std::size_t i = 0; i < std::max(stream.points.size(), stream.lines.size()); ++i) {
    if (i < stream.points.size()) contract.addPoints(stream.points[i]);
    if (i < stream.lines.size()) contract.addLines(stream.lines[i]);
  }
  contract.finish();
  return contract;
}

struct SeededFault {
  const char* name;
  std::function<void(Stream&)> seed;
  Rule rule;
  double stamp;
  double id;  ///< NaN: the whole message
};

std::vector<SeededFault> seededFaults() {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {
      {"a line message is lost", [](Stream& s) { s.lines.erase(s.lines.begin() + 20); },
       Rule::kMissingMessage, 12.0, none},
      {"a line message too many",
       [](Stream& s) {
         s.lines.insert(s.lines.begin() + 8, s.lines[8]);
         s.lines[8].header.stamp -= ros::Duration(0.05);
       },
       Rule::kExtraMessage, 10.75, none},
      {"another stamp", [](Stream& s) { s.lines[7].header.stamp += ros::Duration(0.01); }, Rule::kStamp,
       10.71, none},
      {"two messages out of order", [](Stream& s) { std::swap(s.lines[20], s.lines[19]); }, Rule::kOrder,
       11.9, none},
      {"another frame", [](Stream& s) { s.lines[3].header.frame_id = "cam0"; }, Rule::kFrame, 10.3, none},
      {"a channel is missing", [](Stream& s) { s.lines[20].channels.pop_back(); }, Rule::kChannels, 12.0,
       none},
      {"a channel is too short", [](Stream& s) { s.lines[20].channels[2].values.push_back(1.0F); },
       Rule::kChannels, 12.0, none},
      {"an end is NaN", [nan](Stream& s) { s.lines[29].channels[1].values[2] = nan; }, Rule::kNotFinite, 12.9,
       102.0},
      {"z is 0", [](Stream& s) { s.lines[5].points[3].z = 0.0F; }, Rule::kDepth, 10.5, 4.0},
      {"an id has a fraction", [](Stream& s) { s.lines[29].channels[0].values[1] = 101.5F; },
       Rule::kIdNotWhole, 12.9, 101.5},
      {"a negative id", [](Stream& s) { s.lines[29].channels[0].values[0] = -1.0F; }, Rule::kIdNegative, 12.9,
       -1.0},
      {"an id beyond 2^24", [](Stream& s) { s.lines[29].channels[0].values[0] = 16777216.0F; },
       Rule::kIdTooLarge, 12.9, 16777216.0},
      {"an id twice in a message", [](Stream& s) { s.lines[29].channels[0].values[4] = 100.0F; },
       Rule::kIdTwice, 12.9, 100.0},
      {"a line is away for one message",
       [](Stream& s) {
         s.lines[25].points.erase(s.lines[25].points.begin() + 2);
         for (auto& channel : s.lines[25].channels) channel.values.erase(channel.values.begin() + 2);
       },
       Rule::kIdReturned, 12.6, 102.0},
      {"an old id for a new line", [](Stream& s) { s.lines[29].channels[0].values[0] = 1.0F; },
       Rule::kIdReturned, 12.9, 1.0},
      {"start and end are swapped",
       [](Stream& s) {
         sensor_msgs::PointCloud& cloud = s.lines[29];
         std::swap(cloud.points[5].x, cloud.channels[1].values[5]);
         std::swap(cloud.points[5].y, cloud.channels[2].values[5]);
       },
       Rule::kIdJumped, 12.9, 105.0},
  };
}

TEST(PlVinsContract, FindsNothingInAGoodStream) {
  PlVinsContract contract = judged(goodStream());
  EXPECT_TRUE(contract.takeFaults().empty());
  EXPECT_EQ(contract.pairs(), 30U);
  EXPECT_EQ(contract.emptyMessages(), 1U);
  EXPECT_EQ(contract.lines(), 29U * 6U);
  EXPECT_EQ(contract.ids(), 9U + 6U);
}

TEST(PlVinsContract, FindsEverySeededFaultWithItsStampAndId) {
  for (const SeededFault& fault : seededFaults()) {
    Stream stream = goodStream();
    fault.seed(stream);
    const std::vector<ContractFault> found = judged(stream).takeFaults();
    ASSERT_FALSE(found.empty()) << fault.name;
    bool hit = false;
    for (const ContractFault& f : found) {
      hit = hit || (f.rule == fault.rule && std::abs(f.stamp.toSec() - fault.stamp) < 1e-6 &&
                    (std::isnan(fault.id) ? std::isnan(f.id) : f.id == fault.id));
    }
    EXPECT_TRUE(hit) << fault.name << ", first found " << nameOf(found[0].rule) << " " << found[0].stamp
                     << " id " << found[0].id << " " << found[0].text;
    if (fault.rule != Rule::kOrder && fault.rule != Rule::kDepth) {
      EXPECT_EQ(found.size(), 1U) << fault.name;
    }
  }
}

TEST(PlVinsContract, FindsTheFaultAfterALostMessageToo) {
  Stream stream = goodStream();
  stream.lines[29].channels[0].values[0] = -1.0F;
  stream.lines.erase(stream.lines.begin() + 20);
  PlVinsContract contract = judged(stream);
  EXPECT_EQ(contract.faults().size(), 2U);
  EXPECT_EQ(contract.pairs(), 29U);
}

TEST(PlVinsContract, ReportsPointsThatAreLeftAtTheEnd) {
  Stream stream = goodStream();
  stream.lines.resize(28);
  const auto found = judged(stream).takeFaults();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].rule, Rule::kMissingMessage);
  EXPECT_EQ(found[1].stamp, ros::Time(12.9));
}

TEST(PlVinsContract, BeginsARunningStreamWithTheFirstPairAndFindsWhatIsLostAfterIt) {
  for (const bool points_first : {true, false}) {
    Stream stream = goodStream();
    stream.lines.erase(stream.lines.begin() + 20);
    PlVinsContract contract;
    contract.joinRunningStream();
    for (std::size_t i = 0; i < 30; ++i) {
      if (points_first || i >= 3) contract.addPoints(stream.points[i]);
      if ((!points_first || i >= 3) && i < 29) contract.addLines(stream.lines[i]);
    }
    contract.finish();
    const std::vector<ContractFault> found = contract.takeFaults();
    ASSERT_EQ(found.size(), 1U) << points_first;
    EXPECT_EQ(found[0].rule, Rule::kMissingMessage);
    EXPECT_EQ(found[0].stamp, ros::Time(12.0));
    EXPECT_EQ(contract.pairs(), 26U);
  }
}

TEST(PlVinsContract, JudgesARunningStreamThoughNoTwoStampsAreTheSame) {
  Stream stream = goodStream();
  for (auto& lines : stream.lines) lines.header.stamp += ros::Duration(0.01);
  PlVinsContract contract;
  contract.joinRunningStream();
  for (std::size_t i = 0; i < 30; ++i) {
    contract.addPoints(stream.points[i]);
    contract.addLines(stream.lines[i]);
  }
  EXPECT_EQ(contract.faults().at(Rule::kStamp), 29U);
  EXPECT_EQ(contract.pairs(), 0U);
}

class CheckPlVinsContract : public ::testing::Test {
 protected:
  std::string write(const Stream& stream) {
    const std::string path = (folder_.path() / "test.bag").string();
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (const ros::Time& stamp : stream.points) {
      sensor_msgs::PointCloud points;
      points.header.stamp = stamp;
      bag.write("/feature_tracker/feature", stamp, points);
    }
    for (const auto& lines : stream.lines) {
      bag.write("/linefeature_tracker/linefeature", lines.header.stamp, lines);
    }
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(CheckPlVinsContract, PassesAGoodBag) {
  const ToolRun run = runTool("check_plvins_contract", {write(goodStream())});
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  EXPECT_NE(run.output.find("30 pairs of messages, 1 without lines, 174 lines of 15 ids, 0 broken rules"),
            std::string::npos)
      << run.output;
}

TEST_F(CheckPlVinsContract, ReportsStampAndIdOfWhatIsBroken) {
  Stream stream = goodStream();
  stream.lines[29].channels[0].values[0] = -1.0F;
  const ToolRun run = runTool("check_plvins_contract", {write(stream)});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("12.900000000 id_negative id -1:"), std::string::npos) << run.output;
}

TEST_F(CheckPlVinsContract, RefusesABagWithoutTheTopics) {
  const ToolRun run = runTool("check_plvins_contract", {write(goodStream()), "--preset", "eplf_vins"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("/lf_feature_tracker/feature"), std::string::npos) << run.errors;
  EXPECT_EQ(runTool("check_plvins_contract", {"/nowhere.bag"}).status, 1);
  EXPECT_EQ(runTool("check_plvins_contract", {"/nowhere.bag", "--preset", "vins"}).status, 1);
}

}  // namespace
}  // namespace tet_line_tracker
