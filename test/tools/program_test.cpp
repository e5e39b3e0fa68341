/// What the tools share.

#include <gtest/gtest.h>

#include "program.h"

namespace tet_line_tracker {
namespace {

std::string logOf(std::chrono::steady_clock::duration period) {
  testing::internal::CaptureStderr();
  {
    ProgressBar progress(4, period);
    for (int i = 0; i < 4; ++i) progress.advance();
  }
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressBar, WritesWholeLinesNowAndThenWhereThereIsNoTerminal) {
  EXPECT_EQ(logOf(std::chrono::seconds(0)), "25 %\n50 %\n75 %\n100 %\n");
  EXPECT_EQ(logOf(std::chrono::hours(1)), "");
}

}  // namespace
}  // namespace tet_line_tracker
