#include "stream_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

constexpr std::array<const char*, static_cast<std::size_t>(DropReason::kCount)> kDropNames{
    "queue", "late stamp", "duplicate stamp", "zero stamp", "unreadable"};

constexpr std::array<const char*, 6> kStageNames{"pyramid", "prior", "flow", "refine", "detect", "undistort"};

std::array<double, 6> stagesOf(const FrameStatistics& statistics) {
  return {statistics.pyramid_ms, statistics.prior_ms,  statistics.flow_ms,
          statistics.refine_ms,  statistics.detect_ms, statistics.undistort_ms};
}

constexpr std::array<const char*, 4> kPriorNames{"imu", "image", "odometry", "none"};

double meanAgeOf(const LineFrame& frame) {
  MeanAndMax age;
  for (const TrackedLine& line : frame.lines) age.add(line.age);
  return age.mean();
}

void addMeanAndMax(const std::string& what, const MeanAndMax& extent,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.addf(what + ", mean [ms]", "%.2f", extent.mean());
  status.addf(what + ", max [ms]", "%.2f", extent.max);
}

double percent(std::uint64_t count, const MeanAndMax& all) {
  return all.count == 0 ? 0.0 : 100.0 * static_cast<double>(count) / static_cast<double>(all.count);
}

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void MeanAndMax::add(double value) {
  sum += value;
  max = count == 0 ? value : std::max(max, value);
  ++count;
}

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

void StreamDiagnostics::addTracked(const LineFrame& frame) {
  const FrameStatistics& statistics = frame.statistics;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++tracked_;
  ++interval_.tracked;
  interval_.image_ms.add(statistics.total_ms);
  const std::array<double, kStages> stages = stagesOf(statistics);
  for (std::size_t i = 0; i < kStages; ++i) interval_.stage_ms[i].add(stages[i]);
  interval_.lines.add(static_cast<double>(frame.lines.size()));
  interval_.started.add(statistics.lines_added);
  interval_.lost.add(std::accumulate(statistics.lost.begin(), statistics.lost.end(), 0.0));
  for (std::size_t i = 0; i < kPriors; ++i) {
    if (statistics.prior == kPriorNames[i]) ++interval_.predicted[i];
  }
  const bool translates = std::any_of(statistics.translation.begin(), statistics.translation.end(),
                                      [](float part) { return part != 0.0F; });
  if (translates) ++interval_.translated;

  lines_added_ += statistics.lines_added;
  lines_cut_ += statistics.lines_cut;
  lines_left_out_ += statistics.lines_left_out;
  for (std::size_t i = 0; i < lines_lost_.size(); ++i) lines_lost_[i] += statistics.lost[i];
  lines_live_ = frame.lines.size();
  mean_age_ = meanAgeOf(frame);
  coverage_ = statistics.coverage;
  prior_ = statistics.prior;
  imu_time_offset_s_ = statistics.imu_time_offset;
  epoch_ = frame.epoch;
  width_ = frame.width;
  height_ = frame.height;
}

void StreamDiagnostics::addPublished(double latency_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++published_;
  ++interval_.published;
  interval_.latency_ms.add(1e3 * latency_s);
}

std::uint64_t StreamDiagnostics::addDropped(DropReason reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ++dropped_[static_cast<std::size_t>(reason)];
}

void StreamDiagnostics::addWait(double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  interval_.wait_ms.add(1e3 * seconds);
}

void StreamDiagnostics::addWithoutSamples() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++without_samples_;
}

void StreamDiagnostics::setDroppedInQueue(std::uint64_t total) {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_[static_cast<std::size_t>(DropReason::kQueue)] = total;
}

void StreamDiagnostics::setDetector(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  detector_ = name;
}

void StreamDiagnostics::setGyroBias(const Eigen::Vector3d& bias) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gyro_bias_ = bias;
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
  const StatusSummary summary = hysteresis_.update(summarize(setup, interval));
  if (received_ == 0) hysteresis_.reset();  // a node that waits for its camera has had no trouble
  status.summary(summary.level, summary.message);
  addKeys(setup, interval, status);
}

void StreamDiagnostics::addKeys(const Setup& setup, const Interval& interval,
                                diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("image topic", setup.image_topic);
  status.add("image size", std::to_string(width_) + "x" + std::to_string(height_));
  status.add("calibration", setup.calibration);
  status.add("detector", detector_);
  status.add("epoch", epoch_);
  const double duration = std::max(1e-3, seconds(interval_.start - interval.start));
  status.addf("images in [Hz]", "%.2f", static_cast<double>(interval.received) / duration);
  status.addf("messages out [Hz]", "%.2f", static_cast<double>(interval.published) / duration);
  addTimes(interval, status);
  status.add("images received", received_);
  status.add("images tracked", tracked_);
  status.add("images without their imu or odometry messages", without_samples_);
  status.add("messages published", published_);
  for (std::size_t i = 0; i < dropped_.size(); ++i) {
    status.add(std::string("images dropped: ") + kDropNames[i], dropped_[i]);
  }
  addMotion(setup, interval, status);
  addLines(interval, status);
}

void StreamDiagnostics::addTimes(const Interval& interval,
                                 diagnostic_updater::DiagnosticStatusWrapper& status) const {
  addMeanAndMax("latency from stamp to publishing", interval.latency_ms, status);
  addMeanAndMax("wait for imu or odometry", interval.wait_ms, status);
  addMeanAndMax("time per image", interval.image_ms, status);
  for (std::size_t i = 0; i < kStages; ++i) {
    addMeanAndMax(std::string("time for ") + kStageNames[i], interval.stage_ms[i], status);
  }
}

void StreamDiagnostics::addMotion(const Setup& setup, const Interval& interval,
                                  diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("prior in use", prior_);
  for (std::size_t i = 0; i < kPriors; ++i) {
    status.addf(std::string("images predicted by ") + kPriorNames[i] + " [%]", "%.0f",
                percent(interval.predicted[i], interval.image_ms));
  }
  status.addf("images with a known translation [%]", "%.0f", percent(interval.translated, interval.image_ms));
  status.add("imu", setup.imu);
  if (setup.imu_lag_s) status.addf("imu lag [ms]", "%.1f", 1e3 * *setup.imu_lag_s);
  status.addf("imu time offset [s]", "%.4f", imu_time_offset_s_);
  for (int i = 0; i < 3; ++i) {
    status.addf(std::string("gyroscope bias, ") + "xyz"[i] + " [rad/s]", "%.5f", gyro_bias_[i]);
  }
  status.add("odometry", setup.odometry);
  if (setup.odometry_lag_s) status.addf("odometry lag [ms]", "%.1f", 1e3 * *setup.odometry_lag_s);
}

void StreamDiagnostics::addLines(const Interval& interval,
                                 diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("lines live", lines_live_);
  status.addf("line age, mean [images]", "%.1f", mean_age_);
  status.addf("image covered by lines [%]", "%.0f", 100.0 * static_cast<double>(coverage_));
  status.addf("lines started per image", "%.2f", interval.started.mean());
  status.addf("lines lost per image", "%.2f", interval.lost.mean());
  status.add("lines started", lines_added_);
  status.add("lines cut to the field of view", lines_cut_);
  status.add("lines left out of the field of view", lines_left_out_);
  for (std::size_t i = 0; i < lines_lost_.size(); ++i) {
    status.add(std::string("lines lost: ") + nameOf(static_cast<LossReason>(i)), lines_lost_[i]);
  }
}

StatusSummary StreamDiagnostics::summarize(const Setup& setup, const Interval& interval) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  Drops dropped{};
  for (std::size_t i = 0; i < dropped.size(); ++i) dropped[i] = dropped_[i] - interval.dropped[i];
  const std::uint64_t unreadable = dropped[static_cast<std::size_t>(DropReason::kUnreadable)];
  const std::uint64_t all = std::accumulate(dropped.begin(), dropped.end(), std::uint64_t{0});
  const bool few_lines = interval.tracked > 0 && few_lines_.update(interval.lines.mean());
  const std::string lines = std::to_string(lines_live_) + " lines";

  const double silence = seconds(Clock::now() - last_image_);
  if (silence > kSilence) {
    const std::string whole = std::to_string(std::llround(silence));
    return {Status::ERROR, "no image for " + whole + " s on " + setup.image_topic};
  }
  if (unreadable > 0) return {Status::ERROR, std::to_string(unreadable) + " images could not be read"};
  if (all > 0) {
    return {Status::WARN,
            std::to_string(all) + " of " + std::to_string(interval.received) + " images dropped"};
  }
  if (received_ == 0) return {Status::WARN, "waiting for the first image"};
  if (!setup.calibrated) return {Status::WARN, lines + ", not calibrated"};
  if (!setup.imu_in_step || !setup.odometry_in_step) {
    return {Status::WARN, lines + ", the " + (setup.imu_in_step ? "odometry" : "imu") + " is out of step"};
  }
  if (few_lines) {
    return {Status::WARN, lines + ", fewer than an estimator needs"};
  }
  return {Status::OK, lines};
}

}  // namespace tet_line_tracker
