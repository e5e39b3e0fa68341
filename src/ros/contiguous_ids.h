#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {

/// Gives the lines of a stream of messages ids for an estimator that reads them as 32-bit floats and takes
/// the k-th sight of an id for the k-th message in a row: whole numbers that a float holds exactly, never
/// negative, the same only while a line is in every message. A line that was missing from one message, or
/// that belongs to a tracker that was reset or restarted in between, gets a new id.
class ContiguousIds {
 public:
  static constexpr std::uint32_t kFirst = 1;
  static constexpr std::uint32_t kLast = (1U << 24) - 1;  ///< a float holds all whole numbers up to 2^24

  /// `next`: the id of the first new line, kFirst..kLast. After kLast comes kFirst again, so an id is used a
  /// second time only after more than 16 million new lines, and never while a line still has it.
  explicit ContiguousIds(std::uint32_t next = kFirst) : next_(next) {}

  /// Ids for `lines`, those of `array` that are sent, in their order. No id of the tracker may occur twice.
  std::vector<std::uint32_t> assign(const LineArray& array, const std::vector<const Line*>& lines);
  /// A message without lines is sent.
  void assignNone() { sent_.clear(); }

 private:
  struct Sent {
    std::uint32_t id;
    std::uint32_t age;  ///< as the tracker said it
  };

  std::uint32_t next_;
  std::unordered_map<std::uint64_t, Sent> sent_;  ///< lines of the last message by the tracker's id
  std::uint32_t epoch_{0};                        ///< of the last message
  std::uint64_t image_count_{0};
};

}  // namespace tet_line_tracker
