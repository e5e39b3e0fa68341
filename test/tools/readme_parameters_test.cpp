#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../../src/ros/node_parameters.h"
#include "../../src/ros/pl_vins_pairing.h"
#include "parameter_markdown.h"
#include "tet_line_tracker/mapping/line_mapper.h"

namespace tet_line_tracker {
namespace {

/// Holds the table of a node in a text of the project against the one of the code.
void expectTable(const std::string& path, const std::string& node, const ParameterTable& table) {
  std::ifstream file(TET_SOURCE_DIRECTORY "/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  ASSERT_TRUE(file) << path;
  EXPECT_EQ(text.str(), withParameters(text.str(), node, markdownOf(table, node)))
      << "update it: rosrun tet_line_tracker list_parameters --node " << node << " --update " << path;
}

TEST(ReadmeParameters, AreThoseOfTheCode) {
  LineTrackerParameters tracker;
  NodeParameters node;
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(node));
  expectTable("README.md", kTrackerNode, table);
}

TEST(VioParameters, OfTheBridgeAreThoseOfTheCode) {
  PlVinsParameters bridge;
  expectTable("docs/vio.md", "pl_vins_bridge", tableOf(bridge));
}

TEST(VioParameters, OfTheMapperAreThoseOfTheCode) {
  LineMapperParameters mapper;
  LineMapperNodeParameters node;
  ParameterTable table = tableOf(mapper);
  table.append(tableOf(node));
  expectTable("docs/vio.md", "line_mapper", table);
}

TEST(ReadmeParameters, ShowDefaultRangeUnitAndMeaning) {
  bool flag = true;
  int window = 7;
  int levels = 3;
  std::string pose;
  double gap = 0.5;
  std::string method = "paper";
  ParameterTable table;
  table.add("flag", flag, "A switch");
  table.add("window", window, 3, 21, "px", "Side of the patch").odd = true;
  table.add("levels", levels, 1, 8, "", "Images").change = ParameterTable::Change::kNewEpoch;
  table.add("pose", pose, {}, "Where it is").change = ParameterTable::Change::kAtStart;
  table.add("gap", gap, 0.001, 3600.0, "s", "Longest gap");
  table.add("method", method, {"paper", "joint"}, "Which one");
  EXPECT_EQ(markdownOf(table, kTrackerNode),
            "| name | default | range | unit | live | meaning |\n|---|---|---|---|---|---|\n"
            "| `flag` | `true` | `true`, `false` |  | yes | A switch |\n"
            "| `window` | `7` | 3 to 21, odd | px | yes | Side of the patch |\n"
            "| `levels` | `3` | 1 to 8 |  | new epoch | Images |\n"
            "| `pose` | (empty) | any |  | no | Where it is |\n"
            "| `gap` | `0.5` | 0.001 to 3600 | s | yes | Longest gap |\n"
            "| `method` | `paper` | `paper`, `joint` |  | yes | Which one |\n");
}

TEST(ReadmeParameters, OfNodesThatReadThemOnceAreNotCalledLive) {
  bool flag = true;
  ParameterTable table;
  table.add("flag", flag, "A switch");
  EXPECT_EQ(markdownOf(table, "line_mapper"),
            "| name | default | range | unit | meaning |\n|---|---|---|---|---|\n"
            "| `flag` | `true` | `true`, `false` |  | A switch |\n");
}

TEST(ReadmeParameters, ReplaceOnlyWhatIsBetweenTheMarkers) {
  const std::string begin =
      "<!-- parameters: rosrun tet_line_tracker list_parameters --update README.md -->\n";
  const std::string end = "<!-- end of parameters -->\n";
  const std::string begin_other =
      "<!-- parameters: rosrun tet_line_tracker list_parameters --node other --update docs/other.md -->\n";
  const std::string text =
      "before\n" + begin + "old\n" + end + "between\n" + begin_other + "older\n" + end + "after\n";
  EXPECT_EQ(withParameters(text, kTrackerNode, "new\n"),
            "before\n" + begin + "\nnew\n\n" + end + "between\n" + begin_other + "older\n" + end + "after\n");
  EXPECT_EQ(withParameters(text, "other", "new\n"),
            "before\n" + begin + "old\n" + end + "between\n" + begin_other + "\nnew\n\n" + end + "after\n");
  EXPECT_THROW(withParameters(text, "third", "new\n"), std::runtime_error);
  EXPECT_THROW(withParameters("no marker", kTrackerNode, "new\n"), std::runtime_error);
}

}  // namespace
}  // namespace tet_line_tracker
