#include "stream_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <numeric>

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

constexpr std::array<const char*, static_cast<std::size_t>(DropReason::kCount)> kDropNames{
    "queue", "late stamp", "duplicate stamp", "zero stamp", "unreadable"};

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Drop dropOf(StreamVerdict verdict) {
  if (verdict == StreamVerdict::kDropZero) return {DropReason::kZero, "it has no stamp"};
  if (verdict == StreamVerdict::kDropDuplicate) {
    return {DropReason::kDuplicate, "its stamp is the one of the image before"};
  }
  return {DropReason::kLate, "its stamp is before the last one"};
}

void StreamDiagnostics::addReceived() {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_image_ = Clock::now();
  ++received_;
  ++interval_.received;
}

void StreamDiagnostics::addTracked(const LineFrame& frame, double milliseconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++tracked_;
  ++interval_.tracked;
  interval_.sum_ms += milliseconds;
  interval_.max_ms = std::max(interval_.max_ms, milliseconds);
  lines_live_ = frame.lines.size();
  lines_added_ += frame.statistics.lines_added;
  lines_cut_ += frame.statistics.lines_cut;
  lines_left_out_ += frame.statistics.lines_left_out;
  for (std::size_t i = 0; i < lines_lost_.size(); ++i) lines_lost_[i] += frame.statistics.lost[i];
  imu_time_offset_s_ = frame.statistics.imu_time_offset;
  epoch_ = frame.epoch;
  width_ = frame.width;
  height_ = frame.height;
}

void StreamDiagnostics::addPublished() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++published_;
  ++interval_.published;
}

std::uint64_t StreamDiagnostics::addDropped(DropReason reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ++dropped_[static_cast<std::size_t>(reason)];
}

void StreamDiagnostics::addWithoutSamples() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++without_samples_;
}

void StreamDiagnostics::setDroppedInQueue(std::uint64_t total) {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_[static_cast<std::size_t>(DropReason::kQueue)] = total;
}

double StreamDiagnostics::secondsWithoutImage() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return seconds(Clock::now() - last_image_);
}

void StreamDiagnostics::report(const Setup& setup, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Interval interval = interval_;
  interval_ = Interval{};
  interval_.dropped = dropped_;
  const double duration = std::max(1e-3, seconds(interval_.start - interval.start));

  summarize(setup, interval, status);
  status.add("image topic", setup.image_topic);
  status.add("image size", std::to_string(width_) + "x" + std::to_string(height_));
  status.add("calibration", setup.calibration);
  status.add("imu", setup.imu);
  status.add("odometry", setup.odometry);
  status.addf("imu time offset [s]", "%.4f", imu_time_offset_s_);
  status.add("detector", setup.detector);
  status.add("epoch", epoch_);
  status.addf("images in [Hz]", "%.2f", static_cast<double>(interval.received) / duration);
  status.addf("messages out [Hz]", "%.2f", static_cast<double>(interval.published) / duration);
  const double mean_ms =
      interval.tracked == 0 ? 0.0 : interval.sum_ms / static_cast<double>(interval.tracked);
  status.addf("time per image, mean [ms]", "%.2f", mean_ms);
  status.addf("time per image, max [ms]", "%.2f", interval.max_ms);
  status.add("images received", received_);
  status.add("images tracked", tracked_);
  status.add("images without their imu or odometry messages", without_samples_);
  status.add("messages published", published_);
  for (std::size_t i = 0; i < dropped_.size(); ++i) {
    status.add(std::string("images dropped: ") + kDropNames[i], dropped_[i]);
  }
  status.add("lines live", lines_live_);
  status.add("lines started", lines_added_);
  status.add("lines cut to the field of view", lines_cut_);
  status.add("lines left out of the field of view", lines_left_out_);
  for (std::size_t i = 0; i < lines_lost_.size(); ++i) {
    status.add(std::string("lines lost: ") + nameOf(static_cast<LossReason>(i)), lines_lost_[i]);
  }
}

void StreamDiagnostics::summarize(const Setup& setup, const Interval& interval,
                                  diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using Status = diagnostic_msgs::DiagnosticStatus;
  status.summaryf(Status::OK, "%zu lines", lines_live_);
  Drops dropped{};
  for (std::size_t i = 0; i < dropped.size(); ++i) dropped[i] = dropped_[i] - interval.dropped[i];
  const std::uint64_t unreadable = dropped[static_cast<std::size_t>(DropReason::kUnreadable)];
  const std::uint64_t all = std::accumulate(dropped.begin(), dropped.end(), std::uint64_t{0});

  const double silence = seconds(Clock::now() - last_image_);
  if (silence > kSilence) {
    status.summaryf(Status::ERROR, "no image for %.0f s on %s", silence, setup.image_topic.c_str());
  } else if (unreadable > 0) {
    status.summaryf(Status::ERROR, "%llu images could not be read",
                    static_cast<unsigned long long>(unreadable));
  } else if (all > 0) {
    status.summaryf(Status::WARN, "%llu of %llu images dropped", static_cast<unsigned long long>(all),
                    static_cast<unsigned long long>(interval.received));
  } else if (received_ == 0) {
    status.summary(Status::WARN, "waiting for the first image");
  } else if (!setup.calibrated) {
    status.summaryf(Status::WARN, "%zu lines, not calibrated", lines_live_);
  } else if (!setup.imu_in_step || !setup.odometry_in_step) {
    status.summaryf(Status::WARN, "%zu lines, the %s is out of step", lines_live_,
                    setup.imu_in_step ? "odometry" : "imu");
  }
}

}  // namespace tet_line_tracker
