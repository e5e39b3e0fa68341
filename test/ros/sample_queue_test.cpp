#include "sample_queue.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

AngularVelocity sampleAt(std::int64_t stamp_ns) {
  return {stamp_ns, Eigen::Vector3d::Zero()};
}

TEST(SampleQueue, AMessageIsTakenWithItsStampAndRates) {
  sensor_msgs::Imu message;
  message.header.stamp = ros::Time(3, 5);
  message.angular_velocity.x = 0.1;
  message.angular_velocity.y = -0.2;
  message.angular_velocity.z = 0.3;
  const AngularVelocity sample = toSample(message);
  EXPECT_EQ(sample.stamp_ns, 3000000005);
  EXPECT_EQ(sample.rad_per_s, Eigen::Vector3d(0.1, -0.2, 0.3));
}

TEST(SampleQueue, AnImageTakesTheSamplesUpToItsStampAndOneMore) {
  LineTracker tracker(LineTrackerParameters{});
  SampleQueue<AngularVelocity> queue;
  for (const int stamp : {10, 20, 30, 40, 50}) queue.add(sampleAt(stamp));
  EXPECT_EQ(queue.oldest(), 10);
  queue.feed(25, tracker);
  EXPECT_EQ(queue.oldest(), 30);  // the last one that was taken
  queue.feed(30, tracker);        // it has the one at 30 already
  EXPECT_EQ(queue.oldest(), 30);
  queue.feed(31, tracker);
  EXPECT_EQ(queue.oldest(), 40);
  queue.feed(1000, tracker);
  EXPECT_EQ(queue.oldest(), 50);
  EXPECT_EQ(queue.newest(), 50);
}

TEST(SampleQueue, CoversImagesUpToItsNewestSampleAlsoWhenTheTrackerHasIt) {
  LineTracker tracker(LineTrackerParameters{});
  SampleQueue<AngularVelocity> queue;
  EXPECT_FALSE(queue.covers(10));
  queue.add(sampleAt(10));
  EXPECT_TRUE(queue.covers(10));
  EXPECT_FALSE(queue.covers(11));
  queue.feed(5, tracker);
  EXPECT_TRUE(queue.covers(10));
}

TEST(SampleQueue, IgnoresSamplesThatAreNotNewerOrHaveNoStamp) {
  SampleQueue<AngularVelocity> queue;
  queue.add(sampleAt(0));
  EXPECT_FALSE(queue.newest());
  queue.add(sampleAt(20));
  queue.add(sampleAt(20));
  queue.add(sampleAt(10));
  EXPECT_EQ(queue.oldest(), 20);
  EXPECT_EQ(queue.newest(), 20);
}

TEST(SampleQueue, KeepsTheNewestSamples) {
  SampleQueue<AngularVelocity> queue;
  for (const int stamp : {10, 20, 30, 40}) queue.add(sampleAt(stamp));
  queue.keepNewest(2);
  EXPECT_EQ(queue.oldest(), 30);
  EXPECT_EQ(queue.newest(), 40);
}

}  // namespace
}  // namespace tet_line_tracker
