#include "throttled_warning.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

using std::chrono::seconds;

TEST(ThrottledWarning, LetsOneThroughPerPeriod) {
  ThrottledWarning warning(seconds(10));
  const ThrottledWarning::Clock::time_point start{seconds(1000)};
  EXPECT_TRUE(warning.isDue(start));
  EXPECT_FALSE(warning.isDue(start + seconds(1)));
  EXPECT_FALSE(warning.isDue(start + seconds(9)));
  EXPECT_TRUE(warning.isDue(start + seconds(10)));
  EXPECT_FALSE(warning.isDue(start + seconds(19)));
  EXPECT_TRUE(warning.isDue(start + seconds(20)));
}

TEST(ThrottledWarning, LetsANewTroubleThroughAtOnce) {
  ThrottledWarning warning(seconds(10));
  const ThrottledWarning::Clock::time_point start{seconds(1000)};
  EXPECT_TRUE(warning.isDue(start));
  warning.reset();
  EXPECT_TRUE(warning.isDue(start + seconds(1)));
}

}  // namespace
}  // namespace tet_line_tracker
