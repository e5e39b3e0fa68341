#include "tet_line_tracker/tracking/stream_gate.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kMs = 1000000;

class StreamGateTest : public testing::Test {
 protected:
  StreamVerdict at(std::int64_t ms, int width = 640) { return gate_.admit(ms * kMs, width, 480); }
  StreamGate gate_{StreamParameters{}};
};

TEST_F(StreamGateTest, TheFirstImageBeginsAnEpochAndTheNextOnesContinueIt) {
  EXPECT_EQ(at(1000), StreamVerdict::kNewEpoch);
  EXPECT_EQ(at(1050), StreamVerdict::kTrack);
  EXPECT_EQ(at(1100), StreamVerdict::kTrack);
}

TEST_F(StreamGateTest, LateEqualAndZeroStampsAreDroppedAndCounted) {
  at(1000);
  at(1050);
  EXPECT_EQ(at(1020), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1050), StreamVerdict::kDropDuplicate);
  EXPECT_EQ(at(0), StreamVerdict::kDropZero);
  EXPECT_EQ(at(1100), StreamVerdict::kTrack);
  EXPECT_EQ(gate_.dropped().late, 1U);
  EXPECT_EQ(gate_.dropped().duplicate, 1U);
  EXPECT_EQ(gate_.dropped().zero, 1U);
}

TEST_F(StreamGateTest, AStreamThatStaysBehindBeginsANewEpoch) {
  at(5000);
  at(5050);
  EXPECT_EQ(at(1000), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1050), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1100), StreamVerdict::kNewEpoch);
  EXPECT_EQ(at(1150), StreamVerdict::kTrack);
}

TEST_F(StreamGateTest, LateImagesThatDoNotAdvanceOrAreInterruptedDoNotBeginAnEpoch) {
  at(5000);
  EXPECT_EQ(at(1100), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1050), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1000), StreamVerdict::kDropLate);
  EXPECT_EQ(at(5050), StreamVerdict::kTrack);
  EXPECT_EQ(at(1050), StreamVerdict::kDropLate);
  EXPECT_EQ(at(1100), StreamVerdict::kDropLate);
  EXPECT_EQ(at(5100), StreamVerdict::kTrack);
}

TEST_F(StreamGateTest, AGapOverTheLimitBeginsANewEpoch) {
  at(1000);
  EXPECT_EQ(at(2000), StreamVerdict::kTrack);  // a gap of max_gap itself is none
  EXPECT_EQ(at(3001), StreamVerdict::kNewEpoch);
}

TEST_F(StreamGateTest, AnotherImageSizeBeginsANewEpoch) {
  at(1000, 640);
  EXPECT_EQ(at(1050, 320), StreamVerdict::kNewEpoch);
  EXPECT_EQ(at(1100, 320), StreamVerdict::kTrack);
}

TEST_F(StreamGateTest, AfterAResetTheNextImageBeginsAnEpochEvenWithAnOlderStamp) {
  at(1000);
  gate_.reset();
  EXPECT_EQ(at(900), StreamVerdict::kNewEpoch);
}

}  // namespace
}  // namespace tet_line_tracker
