#include "sensor_sync_monitor.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr std::int64_t kMs = 1000000;

/// A 50 Hz camera with an IMU, driven by hand: image i has the stamp 20 i ms and comes at that time.
class SensorSyncMonitorTest : public testing::Test {
 protected:
  SensorSyncMonitor::Clock::time_point at(int ms) const { return start_ + milliseconds(ms); }
  void missImage(int i, milliseconds lag = milliseconds(100), milliseconds affordable = milliseconds(50)) {
    monitor_.addMissed(20 * i * kMs, lag, affordable, at(20 * i));
  }
  /// The message that image i needs comes `delay_ms` after it.
  void messageFor(int i, int delay_ms) { monitor_.addMessage((20 * i + 1) * kMs, at(20 * i + delay_ms)); }
  void getOutOfStep() {
    for (int i = 0; i < SensorSyncMonitor::kImages; ++i) missImage(i);
    ASSERT_FALSE(monitor_.inStep());
  }

  const SensorSyncMonitor::Clock::time_point start_{std::chrono::seconds(1000)};
  SensorSyncMonitor monitor_;
};

TEST_F(SensorSyncMonitorTest, IsOutOfStepAfterAFewImagesInARowWithout) {
  for (int i = 0; i < SensorSyncMonitor::kImages - 1; ++i) missImage(i);
  EXPECT_TRUE(monitor_.inStep());
  missImage(SensorSyncMonitor::kImages, milliseconds(123));
  EXPECT_FALSE(monitor_.inStep());
  EXPECT_EQ(monitor_.lag(), nanoseconds(123 * kMs));
}

TEST_F(SensorSyncMonitorTest, SingleImagesWithoutChangeNothing) {
  for (int i = 0; i < 100; ++i) {
    if (i % SensorSyncMonitor::kImages == 0) {
      monitor_.addCovered();
    } else {
      missImage(i);
    }
  }
  EXPECT_TRUE(monitor_.inStep());
}

TEST_F(SensorSyncMonitorTest, IsBackWhenMessagesWouldHaveComeInTime) {
  getOutOfStep();
  for (int i = 10; i < 10 + SensorSyncMonitor::kImages; ++i) {
    EXPECT_FALSE(monitor_.inStep());
    missImage(i);
    messageFor(i, 10);
  }
  EXPECT_TRUE(monitor_.inStep());
}

TEST_F(SensorSyncMonitorTest, IsBackWhenMessagesWereThereBeforeTheImages) {
  getOutOfStep();
  for (int i = 0; i < SensorSyncMonitor::kImages; ++i) {
    EXPECT_FALSE(monitor_.inStep());
    monitor_.addCovered();
  }
  EXPECT_TRUE(monitor_.inStep());
}

TEST_F(SensorSyncMonitorTest, StaysOutOfStepWhileMessagesComeLaterThanAnImageCanWait) {
  getOutOfStep();
  for (int i = 10; i < 100; ++i) {
    missImage(i);
    if (i >= 13) messageFor(i - 3, 60);
    EXPECT_FALSE(monitor_.inStep()) << i;
  }
}

TEST_F(SensorSyncMonitorTest, AnImageThatCouldNotWaitSetsTheTimeThatCounts) {
  // Newer images pushed: waits ended after 8 ms, so messages after 10 ms are late.
  for (int i = 0; i < SensorSyncMonitor::kImages; ++i) missImage(i, milliseconds(10), milliseconds(8));
  for (int i = 10; i < 30; ++i) {
    missImage(i);
    messageFor(i, 10);
  }
  EXPECT_FALSE(monitor_.inStep());
  for (int i = 30; i < 30 + SensorSyncMonitor::kImages; ++i) {
    missImage(i);
    messageFor(i, 5);
  }
  EXPECT_TRUE(monitor_.inStep());
}

TEST_F(SensorSyncMonitorTest, OneLateMessageBeginsTheCountAnew) {
  getOutOfStep();
  int i = 10;
  for (; i < 10 + SensorSyncMonitor::kImages - 1; ++i) {
    missImage(i);
    messageFor(i, 10);
  }
  missImage(i);
  messageFor(i, 70);
  missImage(++i);
  messageFor(i, 10);
  EXPECT_FALSE(monitor_.inStep());
}

}  // namespace
}  // namespace tet_line_tracker
