#include "tet_line_tracker/tracking/frame_sequence.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace tet_line_tracker {

StreamVerdict FrameSequence::begin(const cv::Mat& gray, std::int64_t stamp_ns) {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw std::invalid_argument("image is " + std::to_string(gray.cols) + "x" + std::to_string(gray.rows) +
                                " of OpenCV type " + std::to_string(gray.type()) +
                                ", needs 8-bit gray (type 0)");
  }
  const StreamVerdict verdict = gate_.admit(stamp_ns, gray.cols, gray.rows);
  if (isDropped(verdict)) return verdict;
  if (verdict == StreamVerdict::kNewEpoch) {
    if (any_epoch_) ++frame_.epoch;
    any_epoch_ = true;
    frame_.image_count = 0;
    frame_.lines.clear();
    dropped_before_epoch_ = gate_.dropped();
  }
  ++frame_.image_count;
  frame_.stamp_ns = stamp_ns;
  frame_.width = gray.cols;
  frame_.height = gray.rows;
  frame_.detected = false;
  frame_.lost.clear();
  FrameStatistics& statistics = frame_.statistics;
  statistics = FrameStatistics{};
  statistics.tracks_before = static_cast<std::uint32_t>(frame_.lines.size());
  statistics.dropped_late = gate_.dropped().late - dropped_before_epoch_.late;
  statistics.dropped_duplicate = gate_.dropped().duplicate - dropped_before_epoch_.duplicate;
  statistics.dropped_zero = gate_.dropped().zero - dropped_before_epoch_.zero;
  return verdict;
}

std::size_t FrameSequence::reset() {
  const std::size_t lines = frame_.lines.size();
  frame_.lines.clear();
  gate_.reset();
  return lines;
}

namespace {

void normalize(const CameraModel* camera, TrackedLine& line) {
  line.forgetNormalized();
  if (camera == nullptr) return;
  const std::optional<Eigen::Vector2d> start = camera->normalize(line.segment.start.cast<double>());
  const std::optional<Eigen::Vector2d> end = camera->normalize(line.segment.end.cast<double>());
  // Where a polynomial turns back, a lens has pixels without a ray within its field of view too.
  if (!start || !end) return;
  line.start_normalized = *start;
  line.end_normalized = *end;
}

}  // namespace

void normalizeEndpoints(const CameraModel* camera, std::vector<TrackedLine>& lines) {
  for (TrackedLine& line : lines) normalize(camera, line);
}

void normalizeMissingEndpoints(const CameraModel* camera, std::vector<TrackedLine>& lines) {
  for (TrackedLine& line : lines) {
    if (!line.start_normalized.allFinite() || !line.end_normalized.allFinite()) normalize(camera, line);
  }
}

}  // namespace tet_line_tracker
