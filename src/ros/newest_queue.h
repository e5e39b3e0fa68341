#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace tet_line_tracker {

/// Hands items from one thread to another, in order. When the taker is too slow the oldest waiting items give
/// way to new ones and are counted. Thread-safe.
template <class Item>
class NewestQueue {
 public:
  /// `capacity`: items that wait at most, 1 or more.
  explicit NewestQueue(std::size_t capacity) : capacity_(capacity) {}

  void push(Item item) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (closed_) return;
      while (items_.size() >= capacity_) {
        items_.pop_front();
        ++replaced_;
      }
      items_.push_back(std::move(item));
    }
    arrived_.notify_one();
  }

  /// Waits for the next item; nothing once the queue is closed.
  std::optional<Item> pop() {
    std::unique_lock<std::mutex> lock(mutex_);
    arrived_.wait(lock, [this] { return closed_ || !items_.empty(); });
    if (closed_) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

  /// For the items to come, 1 or more; those that wait beyond it give way to the next one.
  void setCapacity(std::size_t capacity) {
    const std::lock_guard<std::mutex> lock(mutex_);
    capacity_ = capacity;
  }

  /// Ends the waiting in pop() for good; items that still wait are forgotten.
  void close() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
      items_.clear();
    }
    arrived_.notify_all();
  }

  /// Whether half of its places are taken: the others are for the items that come while one is worked on.
  bool isHalfFull() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return 2 * items_.size() >= capacity_;
  }

  /// Items that gave way to newer ones since construction.
  std::uint64_t replaced() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return replaced_;
  }

 private:
  mutable std::mutex mutex_;  ///< guards everything below
  std::size_t capacity_;
  std::condition_variable arrived_;
  std::deque<Item> items_;
  std::uint64_t replaced_{0};
  bool closed_{false};
};

}  // namespace tet_line_tracker
