/// Every tool that reads a bag ends by itself, with one sentence where it cannot go on, and leaves nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bag_content.h"
#include "tet_line_tracker/LineArray.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<char>;

Bytes bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string lastLine(std::string text) {
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

class BrokenBag : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(runTool("simulate_bag", {in("flight.bag"), "--seconds", "0.2"}).status, 0);
    ASSERT_EQ(runTool("track_bag", {in("flight.bag"), in("tracks.bag"), "--with-images"}).status, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string in(const std::string& name) { return folder_->path() / name; }
  void TearDown() override {
    for (const char* name : {"broken.bag", "packed.bag", "out.bag", "bz2.bag", "lz4.bag"})
      fs::remove(in(name));
  }

  /// A copy with other compression and small chunks.
  void rewrite(const std::string& from, const std::string& to, rosbag::CompressionType compression) const {
    rosbag::Bag source(in(from), rosbag::bagmode::Read);
    rosbag::Bag target(in(to), rosbag::bagmode::Write);
    target.setCompression(compression);
    target.setChunkThreshold(64 * 1024);
    rosbag::View view(source);
    for (const rosbag::MessageInstance& instance : view) {
      target.write(instance.getTopic(), instance.getTime(), instance, instance.getConnectionHeader());
    }
  }
  /// What `tool` does with a bag of these bytes: it must end by itself within a minute.
  ToolRun run(const std::string& tool, const Bytes& bytes) const {
    std::ofstream(in("broken.bag"), std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    std::vector<std::string> arguments{in("broken.bag")};
    const bool writes = tool != "evaluate_tracks" && tool != "check_lines" && tool != "check_plvins_contract";
    if (writes) arguments.push_back(in(tool == "paint_tracks" ? "out.png" : "out.bag"));
    ToolRun run = runTool(tool, arguments, "timeout -s KILL 60 ");
    EXPECT_TRUE(run.status == 0 || run.status == 1) << tool << " ended with " << run.status << run.errors;
    if (run.status == 1) {
      // Verdicts of the two judges go to the standard output.
      const bool verdict = run.errors.empty() && tool.rfind("check_", 0) == 0;
      EXPECT_TRUE(verdict || lastLine(run.errors).rfind(tool + ": ", 0) == 0) << tool << run.errors;
      EXPECT_FALSE(fs::exists(in("out.bag")) || fs::exists(in("out.png"))) << tool;
    }
    fs::remove(in("out.bag"));
    fs::remove(in("out.png"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_->path()), fs::directory_iterator()), files())
        << tool << " left something";
    return run;
  }
  std::ptrdiff_t files() const { return files_ + 1; }

  static const std::vector<std::string>& tools() {
    static const std::vector<std::string> all{"track_bag",       "map_bag",     "paint_tracks",
                                              "evaluate_tracks", "check_lines", "check_plvins_contract"};
    return all;
  }

  static TemporaryFolder* folder_;
  std::ptrdiff_t files_{2};
};

TemporaryFolder* BrokenBag::folder_ = nullptr;

TEST_F(BrokenBag, WithoutContentIsRefusedByEveryTool) {
  std::mt19937 random(1);
  Bytes noise(20000);
  for (char& byte : noise) byte = static_cast<char>(random());
  Bytes version_and_noise = noise;
  const std::string version = "#ROSBAG V2.0\n";
  std::copy(version.begin(), version.end(), version_and_noise.begin());
  for (const std::string& tool : tools()) {
    for (const Bytes& bytes : {Bytes{}, noise, version_and_noise}) {
      const ToolRun result = run(tool, bytes);
      EXPECT_EQ(result.status, 1) << tool;
      EXPECT_NE(result.errors.find("cannot read " + in("broken.bag")), std::string::npos) << result.errors;
    }
  }
}

TEST_F(BrokenBag, CutOffAnywhereIsRefusedByEveryTool) {
  const Bytes whole = bytesOf(in("tracks.bag"));
  std::mt19937 random(2);
  for (const std::string& tool : tools()) {
    for (int i = 0; i < 2; ++i) {
      const auto length = static_cast<std::ptrdiff_t>(1 + random() % (whole.size() - 1));
      const ToolRun result = run(tool, Bytes(whole.begin(), whole.begin() + length));
      EXPECT_EQ(result.status, 1) << tool << " at " << length;
      EXPECT_NE(result.errors.find("cannot read " + in("broken.bag")), std::string::npos) << result.errors;
    }
  }
}

TEST_F(BrokenBag, CompressedByBz2OrLz4IsReadAsAnyOther) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    rewrite("flight.bag", "packed.bag", compression);
    const ToolRun run = runTool("track_bag", {in("packed.bag"), in("out.bag"), "--with-images"});
    EXPECT_EQ(run.status, 0) << run.errors;
    const auto lines = readTopic<LineArray>(in("out.bag"), "/line_tracker/lines");
    const auto plain = readTopic<LineArray>(in("tracks.bag"), "/line_tracker/lines");
    ASSERT_EQ(lines.size(), plain.size());
    EXPECT_EQ(lines.back().message.lines.size(), plain.back().message.lines.size());
  }
}

TEST_F(BrokenBag, DamagedBytesEndNoToolByASignal) {
  std::mt19937 random(3);
  rewrite("tracks.bag", "bz2.bag", rosbag::compression::BZ2);
  rewrite("tracks.bag", "lz4.bag", rosbag::compression::LZ4);
  files_ = 4;
  for (const char* name : {"tracks.bag", "bz2.bag", "lz4.bag"}) {
    const Bytes whole = bytesOf(in(name));
    for (int i = 0; i < 3; ++i) {
      Bytes damaged = whole;
      // Somewhere in the data, in the record headers at the beginning, or in the index at the end.
      const std::size_t at = i % 3 == 0 ? random() % whole.size()
                                        : (i % 3 == 1 ? random() % 6000 : whole.size() - 1 - random() % 6000);
      const std::size_t end = std::min(at + 1 + random() % 64, whole.size());
      for (std::size_t k = at; k < end; ++k) damaged[k] = static_cast<char>(random());
      run(tools()[static_cast<std::size_t>(i) % 2], damaged);
      run(tools()[2 + static_cast<std::size_t>(i) % 4], damaged);
    }
  }
}

}  // namespace
}  // namespace tet_line_tracker
