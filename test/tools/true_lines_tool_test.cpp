#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "tet_line_tracker/LineArray.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

TEST(TrueLinesTool, GivesALineArrayForEachImageThatKeepsTheRulesOfTheMessages) {
  const TemporaryFolder folder;
  const std::string flight = folder.path() / "flight.bag";
  const std::string lines = folder.path() / "lines.bag";
  ASSERT_EQ(runTool("simulate_bag", {flight, "--seconds", "0.5", "--hand-sway", "--no-imu"}).status, 0);
  const ToolRun run = runTool("true_lines", {flight, lines, "--max-lines", "20"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("11 images, 20.0 lines per image"), std::string::npos) << run.output;
  rosbag::Bag bag(lines, rosbag::bagmode::Read);
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/line_tracker/lines")).size(), 11U);
  bag.close();
  const ToolRun rules = runTool("check_lines", {lines});
  EXPECT_EQ(rules.status, 0) << rules.output << rules.errors;
}

TEST(TrueLinesTool, NeedsASimulatedWorld) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "empty.bag";
  rosbag::Bag(path, rosbag::bagmode::Write).close();
  const ToolRun run = runTool("true_lines", {path, folder.path() / "lines.bag"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("has no true scene"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "lines.bag"));
}

}  // namespace
}  // namespace tet_line_tracker
