#include "newest_queue.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(NewestQueue, KeepsTheOrder) {
  NewestQueue<int> queue(3);
  for (int i = 0; i < 3; ++i) queue.push(i);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(queue.pop(), i);
  EXPECT_EQ(queue.replaced(), 0U);
}

TEST(NewestQueue, ReplacesTheOldestAndCounts) {
  NewestQueue<int> queue(2);
  for (int i = 0; i < 5; ++i) queue.push(i);
  EXPECT_EQ(queue.replaced(), 3U);
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.pop(), 4);
}

TEST(NewestQueue, HoldsNoMoreThanItsNewCapacity) {
  NewestQueue<int> queue(4);
  for (int i = 0; i < 4; ++i) queue.push(i);
  queue.setCapacity(2);
  queue.push(4);
  EXPECT_EQ(queue.replaced(), 3U);
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.pop(), 4);
}

TEST(NewestQueue, EndsTheWaitingWhenItIsClosed) {
  NewestQueue<int> queue(2);
  std::optional<int> taken{1};
  std::thread taker([&] { taken = queue.pop(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  queue.close();
  taker.join();
  EXPECT_FALSE(taken.has_value());
  queue.push(1);
  EXPECT_FALSE(queue.pop().has_value());
}

TEST(NewestQueue, GivesEveryItemOnceOrCountsIt) {
  NewestQueue<int> queue(4);
  std::vector<int> taken;
  std::thread taker([&] {
    while (const auto item = queue.pop()) {
      taken.push_back(*item);
      if (*item == 9999) return;
    }
  });
  for (int i = 0; i < 10000; ++i) queue.push(i);
  taker.join();
  EXPECT_EQ(taken.size() + queue.replaced(), 10000U);
  EXPECT_TRUE(std::is_sorted(taken.begin(), taken.end()));
}

TEST(NewestQueue, IsHalfFullWhileThereIsRoomForAsManyItemsAsWait) {
  NewestQueue<int> queue(5);
  for (int i = 0; i < 2; ++i) queue.push(i);
  EXPECT_FALSE(queue.isHalfFull());
  queue.push(2);
  EXPECT_TRUE(queue.isHalfFull());
  queue.pop();
  EXPECT_FALSE(queue.isHalfFull());
  queue.setCapacity(4);
  EXPECT_TRUE(queue.isHalfFull());
}

TEST(NewestQueue, WithOnePlaceIsHalfFullWhenItIsTaken) {
  NewestQueue<int> queue(1);
  EXPECT_FALSE(queue.isHalfFull());
  queue.push(1);
  EXPECT_TRUE(queue.isHalfFull());
}

}  // namespace
}  // namespace tet_line_tracker
