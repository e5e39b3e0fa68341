#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace tet_line_tracker {

/// Samples of a sensor in the order of their stamps, `stamp_ns`.
template <class Sample>
class StampedSamples {
 public:
  /// Takes no sample that is not newer than the last; a jump of the stamps back by more than `max_gap_ns`
  /// starts anew (a bag played in a loop).
  void add(const Sample& sample, std::int64_t max_gap_ns) {
    if (!samples_.empty()) {
      const std::int64_t last = samples_.back().stamp_ns;
      if (sample.stamp_ns < last - max_gap_ns) {
        samples_.clear();
      } else if (sample.stamp_ns <= last) {
        return;
      }
    }
    samples_.push_back(sample);
    if (samples_.size() > kMaxSamples) samples_.pop_front();
  }

  /// Forgets what is not needed to interpolate from `stamp_ns` on.
  void forgetBefore(std::int64_t stamp_ns) {
    while (samples_.size() > 2 && samples_[1].stamp_ns <= stamp_ns) samples_.pop_front();
  }

  const std::deque<Sample>& all() const { return samples_; }

 private:
  static constexpr std::size_t kMaxSamples = 4000;  ///< if nobody ever asks

  std::deque<Sample> samples_;
};

}  // namespace tet_line_tracker
