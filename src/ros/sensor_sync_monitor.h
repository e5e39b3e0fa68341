#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace tet_line_tracker {

/// Judges whether the messages of a sensor come early enough for the images. A sensor that fails kImages
/// images in a row is out of step: images need not wait for it any more. It is in step again when its
/// messages would have been there in time for kImages images in a row. Not thread-safe.
class SensorSyncMonitor {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kImages = 5;

  bool inStep() const { return in_step_; }

  /// An image had its messages.
  void addCovered();
  /// An image went on without. `lag`: by how much the newest message was older than the image when the image
  /// came; less than 0 when the messages are ahead of it. `affordable`: how long it could have waited.
  void addMissed(std::int64_t stamp_ns, std::chrono::nanoseconds lag, Clock::duration affordable,
                 Clock::time_point now);
  /// A message with this stamp came.
  void addMessage(std::int64_t stamp_ns, Clock::time_point now);

  /// The lag when the sensor was last found out of step.
  std::chrono::nanoseconds lag() const { return lag_; }

 private:
  void addHit();

  /// An image that did not wait: did its message come in the time that it could have waited?
  struct Probe {
    std::int64_t stamp_ns;
    Clock::time_point deadline;
  };

  bool in_step_{true};
  int misses_{0};  ///< images in a row while in step
  int hits_{0};    ///< images in a row while out of step
  std::chrono::nanoseconds lag_{0};
  Clock::duration affordable_{0};  ///< shortest of the misses that led out of step
  std::optional<Probe> probe_;
};

}  // namespace tet_line_tracker
