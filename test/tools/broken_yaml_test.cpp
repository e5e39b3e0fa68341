/// Parameter and calibration files that are made to hurt: a sentence, soon.

#include <gtest/gtest.h>

#include <functional>

#include "tool_run.h"

namespace tet_line_tracker {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

/// Nine lists, each of ten times the one before: a thousand million values for who unfolds them.
std::string aliasBomb() {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + repeated(before + ", ", 9) +
            before + "]\n";
  }
  return text;
}

#ifdef __SANITIZE_ADDRESS__  // takes terabytes of address space for itself
constexpr const char* kLimits = "timeout -s KILL 60 ";
#else
constexpr const char* kLimits = "ulimit -v 4000000; timeout -s KILL 60 ";
#endif

class BrokenYaml : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_.path() / name; }
  /// The tool ends with one sentence, within a minute and 4 GB of address space.
  void expectRefusal(const std::string& tool, const std::vector<std::string>& arguments,
                     const std::string& what) {
    const ToolRun run = runTool(tool, arguments, kLimits);
    EXPECT_EQ(run.status, 1) << what << ": " << run.errors.substr(0, 300);
    EXPECT_EQ(run.errors.find('\n'), run.errors.size() - 1) << what << ": " << run.errors.substr(0, 300);
    EXPECT_LT(run.errors.size(), 2000U) << what;
    EXPECT_FALSE(std::filesystem::exists(in("out.bag")));
  }

  TemporaryFolder folder_;
};

TEST_F(BrokenYaml, IsRefusedAsParametersAndAsACalibration) {
  const std::vector<std::string> texts{
      aliasBomb(),
      aliasBomb() + "max_lines: *a8\nimage_width: *a8\n",
      repeated("[", 400),
      "max_lines: " + repeated("[", 100000) + "\nimage_width: 3\n",
      "max_lines: 99999999999999999999999\nimage_width: 99999999999999999999999\n",
      "max_lines: " + repeated("9", 100000) + "\nimage_width: 1e999\n",
      "&a a: *a\n",
      repeated("x", 1000000),
      std::string("max_lines: 1\0 00\n\xff\xfe", 20),
      "",
  };
  for (const std::string& text : texts) {
    writeText(in("hostile.yaml"), text);
    const std::string what = text.substr(0, 40);
    expectRefusal("simulate_bag", {in("out.bag"), "--seconds", "0.1", "--camera-info", in("hostile.yaml")},
                  what);
    if (text.empty()) continue;  // no parameters: nothing to refuse
    expectRefusal("track_bag", {in("in.bag"), in("out.bag"), "--config", in("hostile.yaml")}, what);
  }
}

}  // namespace
}  // namespace tet_line_tracker
