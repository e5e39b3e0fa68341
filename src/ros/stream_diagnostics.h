#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "tet_line_tracker/tracking/line_frame.h"
#include "tet_line_tracker/tracking/stream_gate.h"

namespace tet_line_tracker {

/// Why an image that reached the node was not tracked.
enum class DropReason { kQueue, kLate, kDuplicate, kZero, kUnreadable, kCount };

/// Reason and sentence for an image that the front end dropped.
struct Drop {
  DropReason reason;
  const char* sentence;
};
/// `verdict`: one for which isDropped() holds.
Drop dropOf(StreamVerdict verdict);

/// What came in, what went out and what was lost, for /diagnostics: counts since the start, rates and times
/// since the last report. Times are those of the wall clock and never reach a message with lines.
/// Thread-safe.
class StreamDiagnostics {
 public:
  /// Silence after which the lack of images is an error [s].
  static constexpr double kSilence = 5.0;

  void addReceived();
  void addTracked(const LineFrame& frame, double milliseconds);
  void addPublished();
  /// Gives the number of images dropped for this reason so far, this one included.
  std::uint64_t addDropped(DropReason reason);
  /// Counts an image that was tracked before the message of IMU or odometry after it had come.
  void addWithoutSamples();
  /// Total of images dropped in the queue, which keeps its own count.
  void setDroppedInQueue(std::uint64_t total);

  /// Since the last image, or since the start when none has come [s].
  double secondsWithoutImage() const;

  struct Setup {
    std::string image_topic;
    std::string detector;
    std::string calibration;  ///< as CalibrationInput::state() says
    std::string imu;          ///< what is known of it
    std::string odometry;     ///< what is known of it
    bool calibrated{false};   ///< the last image had normalised endpoints
    bool imu_in_step{true};   ///< its messages come early enough for the images
    bool odometry_in_step{true};
  };
  /// Fills the status and begins the next interval of rates and times.
  void report(const Setup& setup, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  using Clock = std::chrono::steady_clock;
  using Drops = std::array<std::uint64_t, static_cast<std::size_t>(DropReason::kCount)>;

  struct Interval {
    Clock::time_point start{Clock::now()};
    std::uint64_t received{0}, tracked{0}, published{0};
    double sum_ms{0.0}, max_ms{0.0};
    Drops dropped{};  ///< totals at the start of the interval
  };

  void summarize(const Setup& setup, const Interval& interval,
                 diagnostic_updater::DiagnosticStatusWrapper& status) const;

  mutable std::mutex mutex_;  ///< guards everything below
  Interval interval_;
  Clock::time_point last_image_{Clock::now()};
  std::uint64_t received_{0}, tracked_{0}, published_{0};
  std::uint64_t without_samples_{0};
  std::uint64_t lines_added_{0}, lines_cut_{0}, lines_left_out_{0};
  std::array<std::uint64_t, static_cast<std::size_t>(LossReason::kCount)> lines_lost_{};
  Drops dropped_{};
  std::size_t lines_live_{0};
  double imu_time_offset_s_{0.0};
  std::uint32_t epoch_{0};
  int width_{0}, height_{0};
};

}  // namespace tet_line_tracker
