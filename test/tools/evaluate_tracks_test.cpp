#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "tool_run.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> linesOf(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cellsOf(const std::string& row) {
  std::istringstream in(row);
  std::vector<std::string> cells;
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// A short flight and its lines by the default tracker, made once for all tests.
class EvaluateTracks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    ASSERT_EQ(runTool("simulate_bag", {flight(), "--seconds", "0.5"}).status, 0);
    ASSERT_EQ(runTool("track_bag", {flight(), folder_->path() / "first.bag"}).status, 0);
    ASSERT_EQ(
        runTool("track_bag", {flight(), folder_->path() / "second.bag", "--set", "method=paper"}).status, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string flight() { return folder_->path() / "flight.bag"; }
  static std::string in(const std::string& name) { return folder_->path() / name; }

  static TemporaryFolder* folder_;
};
TemporaryFolder* EvaluateTracks::folder_ = nullptr;

TEST_F(EvaluateTracks, WritesTheSameMeasuresAsTextCsvAndJson) {
  const ToolRun run = runTool("evaluate_tracks", {in("first.bag"), in("second.bag"), "--absolute", "--csv",
                                                  in("all.csv"), "--json", in("all.json")});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("first"), std::string::npos);
  EXPECT_NE(run.output.find("second"), std::string::npos);

  const std::vector<std::string> csv = linesOf(in("all.csv"));
  ASSERT_EQ(csv.size(), 3U);
  const std::vector<std::string> names = cellsOf(csv[0]);
  const std::vector<std::string> values = cellsOf(csv[1]);
  // JSON is YAML.
  const YAML::Node json = YAML::LoadFile(in("all.json"));
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[1]["bag"].as<std::string>(), "second");
  std::size_t compared = 0;
  for (std::size_t i = 2; i < std::min(names.size(), values.size()); ++i) {
    if (values[i].empty()) continue;
    EXPECT_NEAR(json[0][names[i]].as<double>(), std::stod(values[i]), 1e-9) << names[i];
    ++compared;
  }
  EXPECT_GE(compared, 15U);
  ASSERT_TRUE(json[0]["absolute_all_judged"]);
  EXPECT_GT(json[0]["absolute_all_judged"].as<int>(), 50);
  EXPECT_GE(json[0]["tracks_per_edge"].as<double>(), 1.0);
  double lines = 0.0;
  for (const char* length : {"30_60", "60_100", "100_160", "160_250", "250_up"}) {
    lines += json[0]["absolute_" + std::string(length) + "_lines"].as<double>();
  }
  EXPECT_EQ(lines, json[0]["absolute_all_lines"].as<double>());

  EXPECT_EQ(json[0]["truth"].as<std::string>(), "scene");
  EXPECT_EQ(json[0]["images"].as<int>(), 11);
  EXPECT_GT(json[0]["inlier_ratio_2px"].as<double>(), 0.99);
  EXPECT_LT(json[0]["error_median_px"].as<double>(), 0.1);
  EXPECT_GT(json[0]["survival"].as<double>(), 0.8);
  // The histogram holds every pair that was judged.
  double pairs = 0.0;
  for (const YAML::Node& count : json[0]["error_histogram"]["counts"]) pairs += count.as<double>();
  EXPECT_EQ(pairs, json[0]["judged_pairs"].as<double>());
}

TEST_F(EvaluateTracks, ExplainsEveryColumnOfItsTable) {
  const ToolRun run = runTool("evaluate_tracks", {in("first.bag"), "--absolute", "--surfaces"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string help = runTool("evaluate_tracks", {"--help"}).output;
  std::istringstream columns(help.substr(std::min(help.size(), help.find("\nColumns"))));
  std::set<std::string> words;
  for (std::string word; columns >> word;) words.insert(word);
  std::size_t names = 0;
  std::size_t tables = 0;
  for (std::size_t start = 0; start != std::string::npos; ++tables) {
    std::istringstream header(run.output.substr(start, run.output.find('\n', start) - start));
    std::string name;
    header >> name;  // bag
    for (; header >> name; ++names) {
      EXPECT_EQ(words.count(name), 1U) << name << " is not explained:\n" << help;
    }
    start = run.output.find("\n\n", start);
    if (start != std::string::npos) start += 2;
  }
  EXPECT_EQ(tables, 3U);
  EXPECT_GE(names, 35U);
}

TEST_F(EvaluateTracks, TellsLinesOnDistractorsFromThoseOnSolidThings) {
  const std::string with = in("with.bag");
  ASSERT_EQ(runTool("simulate_bag", {with, "--seconds", "0.5", "--distractors", "round,mirror"}).status, 0);
  ASSERT_EQ(runTool("track_bag", {with, in("with_lines.bag")}).status, 0);
  const ToolRun run =
      runTool("evaluate_tracks", {in("first.bag"), in("with_lines.bag"), "--surfaces", "--csv",
                                  in("surfaces.csv"), "--json", in("surfaces.json")});
  ASSERT_EQ(run.status, 0) << run.errors;
  const YAML::Node json = YAML::LoadFile(in("surfaces.json"));
  EXPECT_EQ(json[0]["surface_solid_line_share"].as<double>(), 1.0);
  EXPECT_EQ(json[0]["surface_mirror_tracks"].as<int>(), 0);
  EXPECT_LT(json[1]["surface_solid_line_share"].as<double>(), 0.95);
  EXPECT_GT(json[1]["surface_round_tracks"].as<int>() + json[1]["surface_mirror_tracks"].as<int>(), 0);
  double share = 0.0;
  for (const char* kind : {"solid", "round", "cable", "foliage", "person", "mirror", "screen"}) {
    const YAML::Node part = json[1]["surface_" + std::string(kind) + "_line_share"];
    ASSERT_TRUE(part) << kind;
    share += part.as<double>();
  }
  EXPECT_NEAR(share, 1.0, 1e-9);
  const std::vector<std::string> csv = linesOf(in("surfaces.csv"));
  ASSERT_EQ(csv.size(), 3U);
  const std::vector<std::string> names = cellsOf(csv[0]);
  const auto column = std::find(names.begin(), names.end(), "surface_solid_line_share");
  ASSERT_NE(column, names.end());
  const auto number = static_cast<std::size_t>(column - names.begin());
  EXPECT_NEAR(std::stod(cellsOf(csv[2])[number]), json[1]["surface_solid_line_share"].as<double>(), 1e-9);

  const ToolRun refused = runTool("simulate_bag", {in("never.bag"), "--distractors", "ghosts"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(
      refused.errors,
      "simulate_bag: distractor \"ghosts\" is not known; known: none, all, round, cables, foliage, people, "
      "mirror, glossy_floor, screen\n");
  EXPECT_FALSE(fs::exists(in("never.bag")));
}

TEST_F(EvaluateTracks, EndsWithASentenceAndNoFileOnABagWithoutLines) {
  const ToolRun run =
      runTool("evaluate_tracks", {flight(), "--csv", in("never.csv"), "--json", in("never.json")});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.errors, "evaluate_tracks: no lines on /line_tracker/lines in " + flight() + "\n");
  EXPECT_FALSE(fs::exists(in("never.csv")));
  EXPECT_FALSE(fs::exists(in("never.json")));
}

}  // namespace
}  // namespace tet_line_tracker
