#include "sensor_sync_monitor.h"

#include <algorithm>

namespace tet_line_tracker {

void SensorSyncMonitor::addCovered() {
  if (in_step_) {
    misses_ = 0;
  } else {
    addHit();
  }
}

void SensorSyncMonitor::addMissed(std::int64_t stamp_ns, std::chrono::nanoseconds lag,
                                  Clock::duration affordable, Clock::time_point now) {
  if (in_step_) {
    affordable_ = misses_ == 0 ? affordable : std::min(affordable_, affordable);
    if (++misses_ < kImages) return;
    in_step_ = false;
    hits_ = 0;
    lag_ = lag;
    probe_.reset();
    return;
  }
  lag_ = lag;
  if (probe_ && now <= probe_->deadline) return;
  if (probe_) hits_ = 0;
  probe_ = Probe{stamp_ns, now + affordable_};
}

void SensorSyncMonitor::addMessage(std::int64_t stamp_ns, Clock::time_point now) {
  if (in_step_ || !probe_ || stamp_ns < probe_->stamp_ns) return;
  if (now <= probe_->deadline) {
    addHit();
  } else {
    hits_ = 0;
  }
  probe_.reset();
}

void SensorSyncMonitor::addHit() {
  if (++hits_ < kImages) return;
  in_step_ = true;
  misses_ = 0;
  probe_.reset();
}

}  // namespace tet_line_tracker
