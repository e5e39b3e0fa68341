#include "tet_line_tracker/tracking/stream_gate.h"

#include <cmath>

namespace tet_line_tracker {

StreamGate::StreamGate(const StreamParameters& parameters) {
  setParameters(parameters);
}

void StreamGate::setParameters(const StreamParameters& parameters) {
  max_gap_ns_ = static_cast<std::int64_t>(std::llround(parameters.max_gap * 1e9));
}

StreamVerdict StreamGate::admit(std::int64_t stamp_ns, int width, int height) {
  if (stamp_ns == 0) {
    ++dropped_.zero;
    return StreamVerdict::kDropZero;
  }
  bool new_epoch = !last_stamp_ns_ || width != width_ || height != height_;
  if (last_stamp_ns_ && stamp_ns == *last_stamp_ns_) {
    ++dropped_.duplicate;
    return StreamVerdict::kDropDuplicate;
  }
  if (last_stamp_ns_ && stamp_ns < *last_stamp_ns_) {
    late_in_a_row_ = late_in_a_row_ > 0 && stamp_ns > late_stamp_ns_ ? late_in_a_row_ + 1 : 1;
    late_stamp_ns_ = stamp_ns;
    if (late_in_a_row_ < kLateImagesForNewEpoch) {
      ++dropped_.late;
      return StreamVerdict::kDropLate;
    }
    new_epoch = true;
  } else if (last_stamp_ns_ && stamp_ns - *last_stamp_ns_ > max_gap_ns_) {
    new_epoch = true;
  }
  last_stamp_ns_ = stamp_ns;
  width_ = width;
  height_ = height;
  late_in_a_row_ = 0;
  return new_epoch ? StreamVerdict::kNewEpoch : StreamVerdict::kTrack;
}

void StreamGate::reset() {
  last_stamp_ns_.reset();
  late_in_a_row_ = 0;
}

}  // namespace tet_line_tracker
