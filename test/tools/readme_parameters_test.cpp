#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../../src/ros/node_parameters.h"
#include "parameter_markdown.h"

namespace tet_line_tracker {
namespace {

TEST(ReadmeParameters, AreThoseOfTheCode) {
  std::ifstream file(TET_SOURCE_DIRECTORY "/README.md");
  std::ostringstream readme;
  readme << file.rdbuf();
  ASSERT_TRUE(file);

  LineTrackerParameters tracker;
  NodeParameters node;
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(node));
  EXPECT_EQ(readme.str(), withParameters(readme.str(), markdownOf(table)))
      << "update it: rosrun tet_line_tracker list_parameters --update README.md";
}

TEST(ReadmeParameters, ShowDefaultRangeUnitAndMeaning) {
  bool flag = true;
  int window = 7;
  double gap = 0.5;
  std::string method = "paper";
  ParameterTable table;
  table.add("flag", flag, "A switch");
  table.add("window", window, 3, 21, "px", "Side of the patch").odd = true;
  table.add("gap", gap, 0.001, 3600.0, "s", "Longest gap");
  table.add("method", method, {"paper", "joint"}, "Which one");
  EXPECT_EQ(markdownOf(table),
            "| name | default | range | unit | meaning |\n|---|---|---|---|---|\n"
            "| `flag` | `true` | `true`, `false` |  | A switch |\n"
            "| `window` | `7` | 3 to 21, odd | px | Side of the patch |\n"
            "| `gap` | `0.5` | 0.001 to 3600 | s | Longest gap |\n"
            "| `method` | `paper` | `paper`, `joint` |  | Which one |\n");
}

TEST(ReadmeParameters, ReplaceOnlyWhatIsBetweenTheMarkers) {
  const std::string begin =
      "<!-- parameters: rosrun tet_line_tracker list_parameters --update README.md -->\n";
  const std::string end = "<!-- end of parameters -->\n";
  EXPECT_EQ(withParameters("before\n" + begin + "old\n" + end + "after\n", "new\n"),
            "before\n" + begin + "\nnew\n\n" + end + "after\n");
  EXPECT_THROW(withParameters("no marker", "new\n"), std::runtime_error);
}

}  // namespace
}  // namespace tet_line_tracker
