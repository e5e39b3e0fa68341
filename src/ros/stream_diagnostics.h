#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <Eigen/Core>

#include "level_hysteresis.h"
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

/// Mean and maximum of what an interval has seen.
struct MeanAndMax {
  double sum{0.0}, max{0.0};
  std::uint64_t count{0};

  void add(double value);
  double mean() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }
};

/// What came in, what went out and what was lost, for /diagnostics: counts since the start, rates and times
/// since the last report. docs/diagnostics.md lists the keys. Times are those of the wall clock and never
/// reach a message with lines. Thread-safe.
class StreamDiagnostics {
 public:
  /// Silence after which the lack of images is an error [s].
  static constexpr double kSilence = 5.0;
  /// A mean of fewer lines than kFewLines per image is a warning, until there are kEnoughLines again.
  static constexpr double kFewLines = 5.0;
  static constexpr double kEnoughLines = 10.0;

  void addReceived();
  void addTracked(const LineFrame& frame);
  /// `latency_s`: from the stamp of the image to now, by the clock that stamps are made with [s].
  void addPublished(double latency_s);
  /// Gives the number of images dropped for this reason so far, this one included.
  std::uint64_t addDropped(DropReason reason);
  /// An image has waited for the messages of IMU or odometry.
  void addWait(double seconds);
  /// Counts an image that was tracked before the message of IMU or odometry after it had come.
  void addWithoutSamples();
  /// Total of images dropped in the queue, which keeps its own count.
  void setDroppedInQueue(std::uint64_t total);
  /// In use, as in the parameter `detector`.
  void setDetector(const std::string& name);
  /// As LineTracker::gyroBias() [rad/s].
  void setGyroBias(const Eigen::Vector3d& bias);

  /// Since the last image, or since the start when none has come [s].
  double secondsWithoutImage() const;

  struct Setup {
    std::string image_topic;
    std::string calibration;  ///< as CalibrationInput::state() says
    std::string imu;          ///< what is known of it
    std::string odometry;     ///< what is known of it
    bool calibrated{false};   ///< the last image had normalised endpoints
    bool imu_in_step{true};   ///< its messages come early enough for the images
    bool odometry_in_step{true};
    std::optional<double> imu_lag_s, odometry_lag_s;  ///< as SensorInput::lag() says
  };
  /// Fills the status and begins the next interval of rates and times.
  void report(const Setup& setup, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  using Clock = std::chrono::steady_clock;
  using Drops = std::array<std::uint64_t, static_cast<std::size_t>(DropReason::kCount)>;
  static constexpr std::size_t kStages = 6;
  static constexpr std::size_t kPriors = 4;

  struct Interval {
    Clock::time_point start{Clock::now()};
    std::uint64_t received{0}, tracked{0}, published{0};
    MeanAndMax image_ms, latency_ms, wait_ms;
    std::array<MeanAndMax, kStages> stage_ms;
    MeanAndMax lines, started, lost;
    std::array<std::uint64_t, kPriors> predicted{};  ///< images by the prior in use
    std::uint64_t translated{0};                     ///< images with a known translation
    Drops dropped{};                                 ///< totals at the start of the interval
  };

  void addKeys(const Setup& setup, const Interval& interval,
               diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addTimes(const Interval& interval, diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addMotion(const Setup& setup, const Interval& interval,
                 diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addLines(const Interval& interval, diagnostic_updater::DiagnosticStatusWrapper& status) const;
  StatusSummary summarize(const Setup& setup, const Interval& interval);

  mutable std::mutex mutex_;  ///< guards everything below
  Interval interval_;
  LevelHysteresis hysteresis_;
  HysteresisThreshold few_lines_{kFewLines, kEnoughLines};
  Clock::time_point last_image_{Clock::now()};
  std::uint64_t received_{0}, tracked_{0}, published_{0};
  std::uint64_t without_samples_{0};
  std::uint64_t lines_added_{0}, lines_cut_{0}, lines_left_out_{0};
  std::array<std::uint64_t, static_cast<std::size_t>(LossReason::kCount)> lines_lost_{};
  Drops dropped_{};

  // Of the last image:
  std::string detector_;
  std::string prior_{"none"};
  std::size_t lines_live_{0};
  double mean_age_{0.0};
  float coverage_{0.0F};
  double imu_time_offset_s_{0.0};
  Eigen::Vector3d gyro_bias_{Eigen::Vector3d::Zero()};  ///< [rad/s]
  std::uint32_t epoch_{0};
  int width_{0}, height_{0};
};

}  // namespace tet_line_tracker
