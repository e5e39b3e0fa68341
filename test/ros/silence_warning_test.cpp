#include "silence_warning.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tet_line_tracker {
namespace {

using std::chrono::seconds;

const SilenceWarning::Clock::time_point kStart{seconds(1000)};

/// The warning once its answer has come. The clock of the warning stands still meanwhile.
std::optional<std::string> answerOf(SilenceWarning& warning, SilenceWarning::Clock::time_point now) {
  std::optional<std::string> text = warning.update(true, now);
  for (int i = 0; !text && i < 2000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    text = warning.update(true, now);
  }
  return text;
}

TEST(SilenceWarning, TellsWhatWasAskedForOncePerPeriod) {
  SilenceWarning warning([] { return std::string("/left, /right"); });
  EXPECT_FALSE(warning.update(false, kStart));
  EXPECT_EQ(answerOf(warning, kStart), "/left, /right");
  for (int i = 1; i < 60; ++i) EXPECT_FALSE(warning.update(true, kStart + seconds(i)));
  EXPECT_EQ(answerOf(warning, kStart + seconds(60)), "/left, /right");
}

TEST(SilenceWarning, ANewSilenceIsWarnedOfAtOnce) {
  SilenceWarning warning([] { return std::string("none"); });
  EXPECT_EQ(answerOf(warning, kStart), "none");
  EXPECT_FALSE(warning.update(false, kStart + seconds(1)));
  EXPECT_EQ(answerOf(warning, kStart + seconds(10)), "none");
}

TEST(TopicOfTransport, IsTheOneThatARecordingMustHold) {
  EXPECT_EQ(topicOfTransport("/camera/image_raw", "raw"), "/camera/image_raw");
  EXPECT_EQ(topicOfTransport("/camera/image_raw", "compressed"), "/camera/image_raw/compressed");
}

TEST(SilenceWarning, NeverWaitsForTheAnswerAndAsksNoSecondTimeMeanwhile) {
  std::promise<void> master_is_back;
  std::atomic<int> questions{0};
  std::atomic<bool> answered_in_time{false};
  {
    SilenceWarning warning([&, back = master_is_back.get_future().share()] {
      ++questions;
      // An update() that waits for this answer waits in vain, and the test sees that below.
      answered_in_time = back.wait_for(seconds(20)) == std::future_status::ready;
      return std::string("/left");
    });
    EXPECT_FALSE(warning.update(true, kStart));
    EXPECT_FALSE(warning.update(true, kStart + seconds(1)));
    EXPECT_EQ(warning.update(true, kStart + seconds(3)), "unknown, the master does not answer");
    EXPECT_FALSE(warning.update(true, kStart + seconds(60)));
    EXPECT_EQ(warning.update(true, kStart + seconds(63)), "unknown, the master does not answer");
    master_is_back.set_value();
    EXPECT_EQ(answerOf(warning, kStart + seconds(120)), "/left");
  }
  EXPECT_TRUE(answered_in_time);
  EXPECT_EQ(questions, 1);
}

}  // namespace
}  // namespace tet_line_tracker
