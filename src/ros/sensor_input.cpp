#include "sensor_input.h"

#include <cmath>
#include <cstdio>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kJumpNs = 100000000;  // back by more than this: not a late message
constexpr std::size_t kMaxSamples = 4000;    // of a segment, and
constexpr std::size_t kMaxSegments = 4;      // if no image comes

}  // namespace

template <class Sample>
void SensorInput<Sample>::add(const Sample& sample, const std::string& frame) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    frame_ = frame;
    silent_ = false;
    last_stamp_ns_ = sample.stamp_ns;
    if (sample.stamp_ns != 0) {  // as with images, 0 is no stamp
      if (segments_.empty() || sample.stamp_ns < segments_.back().newest().value_or(0) - kJumpNs) {
        segments_.emplace_back();
      }
      segments_.back().add(sample);
      segments_.back().keepNewest(kMaxSamples);
      if (segments_.size() > kMaxSegments) segments_.pop_front();
      monitor_.addMessage(sample.stamp_ns, Clock::now());
    }
  }
  changed_.notify_all();
}

template <class Sample>
bool SensorInput<Sample>::waitFor(std::int64_t stamp_ns, double patience_s,
                                  const std::function<bool()>& is_crowded) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto settled = [&] {
    dropOldSegments(stamp_ns);
    return covers(stamp_ns) || segments_.size() > 1;  // nothing is added to a complete segment
  };
  const auto patience =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience_s));
  if (last_stamp_ns_ != 0) lag_s_ = 1e-9 * static_cast<double>(stamp_ns - last_stamp_ns_);
  const Clock::time_point begin = Clock::now();
  Clock::duration affordable = patience;
  if (!settled() && !silent_ && monitor_.inStep() && !is_crowded()) {
    silent_ = true;
    const bool cut = changed_.wait_for(lock, patience, [&] { return settled() || is_crowded(); });
    if (cut) affordable = Clock::now() - begin;
  }
  if (covers(stamp_ns) && !isAheadOf(stamp_ns)) {
    monitor_.addCovered();
    return true;
  }
  if (!frame_) return false;  // nothing has come that could be out of step
  const Clock::time_point now = Clock::now();
  // A message that comes at its own stamp and a second later is a second late, however long the image waited
  // for it.
  const std::chrono::nanoseconds lag(isAheadOf(stamp_ns) ? stamp_ns - *segments_.front().oldest()
                                                         : stamp_ns - last_stamp_ns_ + (now - begin).count());
  monitor_.addMissed(stamp_ns, lag, affordable, now);
  return false;
}

template <class Sample>
void SensorInput<Sample>::wake() {
  // With the mutex, as the waiting thread might otherwise sleep between its question and the news.
  { const std::lock_guard<std::mutex> lock(mutex_); }
  changed_.notify_all();
}

template <class Sample>
void SensorInput<Sample>::feed(std::int64_t stamp_ns, LineTracker& tracker) {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropOldSegments(stamp_ns);
  if (!segments_.empty()) segments_.front().feed(stamp_ns, tracker);
}

template <class Sample>
std::optional<std::string> SensorInput<Sample>::frame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return frame_;
}

template <class Sample>
std::optional<double> SensorInput<Sample>::lag() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return lag_s_;
}

template <class Sample>
std::optional<std::string> SensorInput<Sample>::outOfStep() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (monitor_.inStep()) return std::nullopt;
  if (last_stamp_ns_ == 0) return "its messages have no stamp";
  const double lag_s = std::chrono::duration<double>(monitor_.lag()).count();
  char text[120];
  std::snprintf(text, sizeof text, "its newest message is %.3f s %s the image", std::abs(lag_s),
                lag_s < 0.0 ? "ahead of" : "behind");
  return std::string(text);
}

/// An image of the time after a jump makes the messages from before it worthless.
template <class Sample>
void SensorInput<Sample>::dropOldSegments(std::int64_t stamp_ns) {
  while (segments_.size() > 1) {
    const Segment& segment = segments_.front();
    const std::optional<std::int64_t> oldest = segment.oldest();
    const bool reaches_back = oldest && stamp_ns >= *oldest - kJumpNs;
    if (reaches_back && (segment.covers(stamp_ns) || !isInLaterSegment(stamp_ns))) return;
    segments_.pop_front();
  }
}

/// One message with a wrong stamp begins a segment too, in which the good ones then go on.
template <class Sample>
bool SensorInput<Sample>::isInLaterSegment(std::int64_t stamp_ns) const {
  for (std::size_t i = 1; i < segments_.size(); ++i) {
    const std::optional<std::int64_t> oldest = segments_[i].oldest();
    if (oldest && *oldest <= stamp_ns && segments_[i].covers(stamp_ns)) return true;
  }
  return false;
}

template <class Sample>
bool SensorInput<Sample>::covers(std::int64_t stamp_ns) const {
  return !segments_.empty() && segments_.front().covers(stamp_ns);
}

/// Whether even the oldest sample lies so far after the image that there is nothing to integrate from.
template <class Sample>
bool SensorInput<Sample>::isAheadOf(std::int64_t stamp_ns) const {
  if (segments_.empty()) return false;
  const std::optional<std::int64_t> oldest = segments_.front().oldest();
  return oldest && *oldest > stamp_ns + kJumpNs;
}

template class SensorInput<AngularVelocity>;
template class SensorInput<BodyPose>;

}  // namespace tet_line_tracker
