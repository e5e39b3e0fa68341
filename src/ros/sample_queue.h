#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "motion_samples.h"

namespace tet_line_tracker {

/// Samples of a sensor by ascending stamps until an image needs them: each image gets those up to its stamp
/// and one after it. The node and track_bag both feed their tracker from here.
template <class Sample>
class SampleQueue {
 public:
  /// A sample without a stamp (0) is ignored, and one that is not newer than the last.
  void add(const Sample& sample) {
    if (sample.stamp_ns == 0) return;
    const std::optional<std::int64_t> last = newest();
    if (!last || sample.stamp_ns > *last) waiting_.push_back(sample);
  }
  /// Forgets the oldest samples until at most `size` wait.
  void keepNewest(std::size_t size) {
    while (waiting_.size() > size) waiting_.pop_front();
  }

  /// Gives `tracker` what it has not had yet of the samples up to the stamp of an image, and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker) {
    while (!waiting_.empty() && !(last_fed_ns_ != 0 && last_fed_ns_ >= stamp_ns)) {
      give(waiting_.front(), tracker);
      last_fed_ns_ = waiting_.front().stamp_ns;
      waiting_.pop_front();
    }
  }

  /// Whether there is a sample at or after `stamp_ns`, given to the tracker or not.
  bool covers(std::int64_t stamp_ns) const {
    const std::optional<std::int64_t> last = newest();
    return last && *last >= stamp_ns;
  }
  /// Stamps of the last sample that the tracker got, or else of the first that waits, and of the newest one
  /// [ns].
  std::optional<std::int64_t> oldest() const {
    if (last_fed_ns_ != 0) return last_fed_ns_;
    if (waiting_.empty()) return std::nullopt;
    return waiting_.front().stamp_ns;
  }
  std::optional<std::int64_t> newest() const {
    if (!waiting_.empty()) return waiting_.back().stamp_ns;
    if (last_fed_ns_ != 0) return last_fed_ns_;
    return std::nullopt;
  }

 private:
  std::deque<Sample> waiting_;
  std::int64_t last_fed_ns_{0};  ///< 0: none yet
};

}  // namespace tet_line_tracker
