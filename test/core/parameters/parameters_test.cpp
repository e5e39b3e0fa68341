#include "tet_line_tracker/parameters/parameters.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

std::string messageOfSetting(ParameterTable& table, const std::string& name, const std::string& text) {
  try {
    table.set(name, text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Parameters, TheDefaultsKeepEveryRule) {
  EXPECT_TRUE(check(LineTrackerParameters{}).empty());
}

TEST(Parameters, ATypingErrorNamesTheNearestParameter) {
  LineTrackerParameters parameters;
  ParameterTable table = tableOf(parameters);
  EXPECT_EQ(messageOfSetting(table, "min_lenght", "30"),
            "parameter min_lenght is not known; did you mean min_length?");
  EXPECT_EQ(messageOfSetting(table, "zzzzzzzzzzzz", "30"),
            "parameter zzzzzzzzzzzz is not known; see the parameters table in README.md");
}

TEST(Parameters, AValueOfTheWrongKindNamesParameterValueAndRange) {
  LineTrackerParameters parameters;
  ParameterTable table = tableOf(parameters);
  EXPECT_EQ(messageOfSetting(table, "window_px", "7.5"),
            "parameter window_px is 7.5, needs an odd number in 3..21 [px]");
  EXPECT_EQ(messageOfSetting(table, "max_gap", "long"),
            "parameter max_gap is long, needs a number in 0.001..3600 [s]");
  EXPECT_EQ(messageOfSetting(table, "min_lines", "1e300"),
            "parameter min_lines is 1e300, needs a whole number in 0..1000");
}

TEST(Parameters, EveryBrokenRangeIsSaid) {
  LineTrackerParameters parameters;
  parameters.flow.window_px = 8;
  parameters.flow.max_residual = 2.0;
  parameters.method = "best";
  parameters.stream.max_gap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check(parameters).size(), 4U);
  LineTrackerParameters few;
  few.detection.min_lines = 100;
  few.detection.max_lines = 50;
  ASSERT_EQ(check(few).size(), 1U);
  EXPECT_EQ(check(few).front(), "parameter min_lines is 100, needs at most max_lines, which is 50");
}

TEST(Parameters, TheImuTimeOffsetIsANumberOfSecondsOrAuto) {
  for (const char* good : {"0", "-0.0123", "0.5", "auto"}) {
    LineTrackerParameters parameters;
    parameters.motion.imu_time_offset = good;
    EXPECT_TRUE(check(parameters).empty()) << good;
  }
  for (const char* bad : {"", "late", "0.02s", "0.6", "nan"}) {
    LineTrackerParameters parameters;
    parameters.motion.imu_time_offset = bad;
    ASSERT_EQ(check(parameters).size(), 1U) << bad;
    EXPECT_NE(check(parameters).front().find("needs auto or a number in -0.5..0.5 [s]"), std::string::npos);
  }
  MotionPriorParameters motion;
  EXPECT_EQ(givenImuTimeOffset(motion), 0.0);
  motion.imu_time_offset = "-0.0123";
  EXPECT_EQ(givenImuTimeOffset(motion), -0.0123);
  motion.imu_time_offset = "auto";
  EXPECT_FALSE(givenImuTimeOffset(motion));
}

TEST(Parameters, EveryValueReadsBackAsItIsWritten) {
  LineTrackerParameters parameters;
  ParameterTable table = tableOf(parameters);
  for (const ParameterTable::Entry& entry : table.entries()) {
    const std::string text = ParameterTable::valueText(entry);
    if (text.empty()) continue;
    table.set(entry.name, text);
    EXPECT_EQ(ParameterTable::valueText(entry), text) << entry.name;
    EXPECT_FALSE(entry.meaning.empty()) << entry.name;
  }
  table.set("min_length", "42.5");
  EXPECT_EQ(parameters.detection.min_length, 42.5);
}

}  // namespace
}  // namespace tet_line_tracker
