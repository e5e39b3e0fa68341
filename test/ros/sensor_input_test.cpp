#include "sensor_input.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace tet_line_tracker {
namespace {

sensor_msgs::Imu messageAt(double stamp_s) {
  sensor_msgs::Imu message;
  message.header.stamp = ros::Time(stamp_s);
  message.header.frame_id = "imu";
  return message;
}

std::int64_t ns(double seconds) {
  return static_cast<std::int64_t>(ros::Time(seconds).toNSec());
}

TEST(ImuInput, AnImageIsCoveredOnceAMessageAtOrAfterItHasCome) {
  ImuInput imu;
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.0));
  imu.add(messageAt(9.99));
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.0));
  imu.add(messageAt(10.0));
  EXPECT_TRUE(imu.waitFor(ns(10.0), 0.0));
  EXPECT_EQ(imu.frame(), "imu");
}

TEST(ImuInput, StaysCoveredByWhatTheTrackerAlreadyHas) {
  LineTracker tracker(LineTrackerParameters{});
  ImuInput imu;
  imu.add(messageAt(10.0));
  imu.add(messageAt(10.02));
  imu.feed(ns(10.01), tracker);
  EXPECT_TRUE(imu.waitFor(ns(10.015), 0.0));
  EXPECT_FALSE(imu.waitFor(ns(10.03), 0.0));
}

TEST(ImuInput, TellsHowFarTheNewestMessageWasBehindTheImage) {
  ImuInput imu;
  imu.waitFor(ns(9.9), 0.0);
  EXPECT_FALSE(imu.lag().has_value());
  imu.add(messageAt(9.99));
  imu.waitFor(ns(10.0), 0.0);
  ASSERT_TRUE(imu.lag().has_value());
  EXPECT_NEAR(*imu.lag(), 0.01, 1e-9);
  imu.add(messageAt(10.07));
  EXPECT_NEAR(*imu.lag(), 0.01, 1e-9) << "until the next image";
  imu.waitFor(ns(10.05), 0.0);
  EXPECT_NEAR(*imu.lag(), -0.02, 1e-9);
}

TEST(ImuInput, WaitsForAMessageThatIsOnItsWay) {
  ImuInput imu;
  std::thread later([&imu] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    imu.add(messageAt(10.01));
  });
  EXPECT_TRUE(imu.waitFor(ns(10.0), 60.0));
  later.join();
}

TEST(ImuInput, ASilentImuIsWaitedForOnceOnly) {
  ImuInput imu;
  imu.add(messageAt(9.0));
  EXPECT_FALSE(imu.waitFor(ns(10.0), 0.001));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(imu.waitFor(ns(10.05), 60.0));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST(ImuInput, ABagThatBeginsAnewServesTheLastImagesOfTheOldRoundAndTheFirstOfTheNew) {
  LineTracker tracker(LineTrackerParameters{});
  ImuInput imu;
  for (const double stamp : {99.0, 99.01, 99.02, 1.0, 1.01, 1.02}) imu.add(messageAt(stamp));
  EXPECT_TRUE(imu.waitFor(ns(99.015), 0.0));
  imu.feed(ns(99.015), tracker);
  // The old round is over: waiting would be in vain.
  EXPECT_FALSE(imu.waitFor(ns(99.03), 60.0));
  imu.feed(ns(99.03), tracker);
  EXPECT_TRUE(imu.waitFor(ns(1.005), 0.0));
  imu.feed(ns(1.005), tracker);
  EXPECT_TRUE(imu.waitFor(ns(1.02), 0.0));
  EXPECT_FALSE(imu.waitFor(ns(1.03), 0.0));
}

/// What a driver sends whose clock or delivery is wrong, and images of a 60 Hz camera that stand for all
/// others.
constexpr double kStart = 5000.0;
constexpr double kPeriod = 1.0 / 60.0;

/// Whether an image would be held up for the IMU: only then it asks whether newer ones crowd.
bool wouldWait(ImuInput& imu, std::int64_t stamp_ns) {
  bool asked = false;
  EXPECT_FALSE(imu.waitFor(stamp_ns, 600.0, [&asked] { return asked = true; }));
  return asked;
}

TEST(ImuInput, AnImuThatIsBehindIsNotWaitedForAfterAFewImages) {
  for (const double behind : {0.5, 1000.0}) {
    ImuInput imu;
    for (int i = 0; i < SensorSyncMonitor::kImages; ++i) {
      EXPECT_FALSE(imu.outOfStep());
      imu.add(messageAt(kStart - behind + kPeriod * i));
      EXPECT_FALSE(imu.waitFor(ns(kStart + kPeriod * i), 0.0));
    }
    ASSERT_TRUE(imu.outOfStep());
    const std::string lag = behind > 1.0 ? "its newest message is 1000.0" : "its newest message is 0.5";
    EXPECT_EQ(imu.outOfStep()->rfind(lag, 0), 0U) << *imu.outOfStep();
    EXPECT_NE(imu.outOfStep()->find("behind the image"), std::string::npos) << *imu.outOfStep();
    for (int i = 10; i < 1000; ++i) {
      imu.add(messageAt(kStart - behind + kPeriod * i));
      EXPECT_FALSE(wouldWait(imu, ns(kStart + kPeriod * i))) << "image " << i;
    }
  }
}

TEST(ImuInput, AnImuWithoutStampsIsNotWaitedForAfterAFewImages) {
  ImuInput imu;
  for (int i = 0; i < SensorSyncMonitor::kImages; ++i) {
    imu.add(messageAt(0.0));
    EXPECT_FALSE(imu.waitFor(ns(kStart + kPeriod * i), 0.001));
  }
  ASSERT_TRUE(imu.outOfStep());
  EXPECT_EQ(*imu.outOfStep(), "its messages have no stamp");
  for (int i = 10; i < 1000; ++i) {
    imu.add(messageAt(0.0));
    EXPECT_FALSE(wouldWait(imu, ns(kStart + kPeriod * i))) << "image " << i;
  }
}

TEST(ImuInput, AnImuThatIsAheadIsOutOfStep) {
  ImuInput imu;
  LineTracker tracker(LineTrackerParameters{});
  for (int i = 0; i < SensorSyncMonitor::kImages; ++i) {
    imu.add(messageAt(kStart + 100.0 + kPeriod * i));
    EXPECT_FALSE(wouldWait(imu, ns(kStart + kPeriod * i))) << "image " << i;
    imu.feed(ns(kStart + kPeriod * i), tracker);
  }
  ASSERT_TRUE(imu.outOfStep());
  EXPECT_NE(imu.outOfStep()->find("s ahead of the image"), std::string::npos) << *imu.outOfStep();
}

TEST(ImuInput, AnImuThatIsInStepAgainIsTakenBack) {
  ImuInput imu;
  for (int i = 0; i < 20; ++i) {
    imu.add(messageAt(kStart - 0.5 + kPeriod * i));
    imu.waitFor(ns(kStart + kPeriod * i), 0.001);
  }
  ASSERT_TRUE(imu.outOfStep());
  for (int i = 20; i < 30; ++i) {
    imu.add(messageAt(kStart + kPeriod * i));
    EXPECT_TRUE(imu.waitFor(ns(kStart + kPeriod * i), 0.0));
  }
  EXPECT_FALSE(imu.outOfStep());
  std::thread later([&imu] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    imu.add(messageAt(kStart + kPeriod * 30));
  });
  EXPECT_TRUE(imu.waitFor(ns(kStart + kPeriod * 30), 60.0));
  later.join();
}

TEST(ImuInput, AnImuThatNeverSentAMessageIsNotOutOfStep) {
  ImuInput imu;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(imu.waitFor(ns(kStart + kPeriod * i), 0.001));
  EXPECT_FALSE(imu.outOfStep());
}

TEST(ImuInput, AnImageGoesOnWithoutItsMessagesWhenNewerOnesCrowd) {
  ImuInput imu;
  imu.add(messageAt(9.99));
  EXPECT_FALSE(imu.waitFor(ns(10.0), 600.0, [] { return true; }));
  std::atomic<bool> crowded{false};
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    crowded = true;
    imu.wake();
  });
  EXPECT_FALSE(imu.waitFor(ns(10.0), 600.0, [&crowded] { return crowded.load(); }));
  later.join();
}

TEST(ImuInput, OneMessageWithAWrongStampDoesNotEndTheUseOfTheOthers) {
  for (const double wrong : {0.0, kStart - 1000.0, kStart + 1000.0}) {
    LineTracker tracker(LineTrackerParameters{});
    ImuInput imu;
    imu.add(messageAt(kStart));
    EXPECT_TRUE(imu.waitFor(ns(kStart), 0.0));
    imu.feed(ns(kStart), tracker);
    imu.add(messageAt(wrong));
    for (int i = 1; i < 10; ++i) {
      imu.add(messageAt(kStart + kPeriod * i));
      EXPECT_TRUE(imu.waitFor(ns(kStart + kPeriod * i), 0.0)) << "image " << i << " after " << wrong;
      imu.feed(ns(kStart + kPeriod * i), tracker);
    }
    EXPECT_FALSE(imu.waitFor(ns(kStart + kPeriod * 11), 0.0)) << "after " << wrong;
  }
}

}  // namespace
}  // namespace tet_line_tracker
