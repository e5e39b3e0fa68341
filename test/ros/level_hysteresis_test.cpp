#include "level_hysteresis.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr unsigned char kOk = 0;
constexpr unsigned char kWarn = 1;
constexpr unsigned char kError = 2;

const StatusSummary kFine{kOk, "40 lines"};
const StatusSummary kDropped{kWarn, "1 of 20 images dropped"};

TEST(LevelHysteresis, ShowsTroubleAtOnce) {
  LevelHysteresis hysteresis;
  EXPECT_EQ(hysteresis.update(kFine).level, kOk);
  const StatusSummary shown = hysteresis.update(kDropped);
  EXPECT_EQ(shown.level, kWarn);
  EXPECT_EQ(shown.message, "1 of 20 images dropped");
}

TEST(LevelHysteresis, WarnsOfTroubleThatIsOverForAWhile) {
  LevelHysteresis hysteresis;
  hysteresis.update({kError, "no image"});
  for (int i = 0; i < LevelHysteresis::kCalmReports; ++i) {
    const StatusSummary shown = hysteresis.update(kFine);
    EXPECT_EQ(shown.level, kWarn) << i;
    EXPECT_EQ(shown.message, "40 lines; shortly before: no image");
  }
  const StatusSummary shown = hysteresis.update(kFine);
  EXPECT_EQ(shown.level, kOk);
  EXPECT_EQ(shown.message, "40 lines");
}

TEST(LevelHysteresis, DoesNotFlickerWithTroubleNowAndThen) {
  LevelHysteresis hysteresis;
  for (int i = 0; i < 40; ++i) {
    const bool drops = i % LevelHysteresis::kCalmReports == 0;
    EXPECT_EQ(hysteresis.update(drops ? kDropped : kFine).level, kWarn) << i;
  }
}

TEST(LevelHysteresis, ForgetsWhenTold) {
  LevelHysteresis hysteresis;
  hysteresis.update(kDropped);
  hysteresis.reset();
  EXPECT_EQ(hysteresis.update(kFine).level, kOk);
}

TEST(HysteresisThreshold, StaysAsItWasWithinTheBand) {
  HysteresisThreshold few(5.0, 10.0);
  EXPECT_FALSE(few.update(7.0));
  EXPECT_TRUE(few.update(4.9));
  EXPECT_TRUE(few.update(9.9));
  EXPECT_FALSE(few.update(10.0));
  EXPECT_FALSE(few.update(5.0));
}

}  // namespace
}  // namespace tet_line_tracker
