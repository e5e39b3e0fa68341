#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "sample_queue.h"
#include "sensor_sync_monitor.h"

namespace tet_line_tracker {

/// Holds the messages of a sensor that moves with the camera until the image that needs them: each image gets
/// those up to its stamp and one after it, whenever they came. A sensor that is out of step is not waited
/// for. Thread-safe.
template <class Sample>
class SensorInput {
 public:
  template <class Message>
  void add(const Message& message) {
    add(toSample(message), frameOf(message));
  }
  /// `frame`: that moves with the camera.
  void add(const Sample& sample, const std::string& frame);

  /// Waits until a message at or after the stamp of an image has come: at most `patience_s`, not while
  /// `is_crowded` (newer images would be lost), and not at all for a sensor that has been silent since it
  /// was last waited for in vain, or that is out of step. False when the image goes without. Call once per
  /// image.
  bool waitFor(
      std::int64_t stamp_ns, double patience_s,
      const std::function<bool()>& is_crowded = [] { return false; });
  /// Has the waiting image ask `is_crowded` again.
  void wake();

  /// Gives `tracker` what it has not had yet up to the stamp of an image and one after it.
  void feed(std::int64_t stamp_ns, LineTracker& tracker);

  /// Of the messages; nothing before the first.
  std::optional<std::string> frame() const;
  /// How much older the newest message was than the image when the image was last given to waitFor() [s];
  /// less than 0: newer. Nothing before the first message with a stamp.
  std::optional<double> lag() const;
  /// A sentence on the measured lag while the sensor is out of step; nothing while it is in step.
  std::optional<std::string> outOfStep() const;

 private:
  /// Messages between two jumps of the stamps, as of a bag that is played in a loop.
  using Segment = SampleQueue<Sample>;
  using Clock = SensorSyncMonitor::Clock;

  void dropOldSegments(std::int64_t stamp_ns);
  bool isInLaterSegment(std::int64_t stamp_ns) const;
  bool covers(std::int64_t stamp_ns) const;
  bool isAheadOf(std::int64_t stamp_ns) const;

  mutable std::mutex mutex_;  ///< guards everything below
  std::condition_variable changed_;
  std::deque<Segment> segments_;  ///< oldest first; each but the last is complete
  SensorSyncMonitor monitor_;
  std::int64_t last_stamp_ns_{0};  ///< of the message that came last
  std::optional<double> lag_s_;
  std::optional<std::string> frame_;
  bool silent_{false};  ///< since a wait in vain
};

using ImuInput = SensorInput<AngularVelocity>;
using OdometryInput = SensorInput<BodyPose>;

}  // namespace tet_line_tracker
