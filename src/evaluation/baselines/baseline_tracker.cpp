#include "baseline_tracker.h"

#include <stdexcept>

#include "../track_measures.h"
#include "lk_endpoints.h"
#include "tracking/stopwatch.h"
#ifdef TET_HAVE_LINE_DESCRIPTOR
#include "lsd_lbd_knn.h"
#endif

namespace tet_line_tracker {

BaselineTracker::BaselineTracker(const LineTrackerParameters& parameters)
    : detection_(parameters.detection), gate_(parameters.stream) {}

const LineFrame* BaselineTracker::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  const StreamVerdict verdict = gate_.admit(stamp_ns, gray.cols, gray.rows);
  if (verdict != StreamVerdict::kTrack && verdict != StreamVerdict::kNewEpoch) return nullptr;
  Stopwatch total;
  if (verdict == StreamVerdict::kNewEpoch) {
    if (any_epoch_) ++frame_.epoch;
    any_epoch_ = true;
    frame_.image_count = 0;
    frame_.lines.clear();
    forget();
  }
  ++frame_.image_count;
  frame_.stamp_ns = stamp_ns;
  frame_.width = gray.cols;
  frame_.height = gray.rows;
  frame_.detected = false;
  frame_.statistics = FrameStatistics{};
  frame_.statistics.tracks_before = static_cast<std::uint32_t>(frame_.lines.size());
  track(gray);
  Stopwatch stage;
  normalizeEndpoints();
  frame_.statistics.undistort_ms = stage.lap();
  frame_.statistics.total_ms = total.lap();
  frame_.statistics.coverage = static_cast<float>(gridCoverage(frame_));
  return &frame_;
}

TrackedLine BaselineTracker::newLine(const LineSegment& segment) {
  TrackedLine line;
  line.id = next_id_++;
  line.segment = segment;
  return line;
}

void BaselineTracker::normalizeEndpoints() {
  const Eigen::Vector2d unknown = TrackedLine{}.start_normalized;
  for (TrackedLine& line : frame_.lines) {
    const auto normalized = [&](const Eigen::Vector2f& pixel) {
      return camera_ ? camera_->normalize(pixel.cast<double>()).value_or(unknown) : unknown;
    };
    line.start_normalized = normalized(line.segment.start);
    line.end_normalized = normalized(line.segment.end);
  }
}

std::vector<std::string> baselineNames() {
  return {
#ifdef TET_HAVE_LINE_DESCRIPTOR
      "lsd_lbd_knn",
#endif
      "lk_endpoints"};
}

std::unique_ptr<BaselineTracker> makeBaselineTracker(const std::string& name,
                                                     const LineTrackerParameters& parameters) {
#ifdef TET_HAVE_LINE_DESCRIPTOR
  if (name == "lsd_lbd_knn") return std::make_unique<LsdLbdKnn>(parameters);
#endif
  if (name == "lk_endpoints") return std::make_unique<LkEndpoints>(parameters);
  std::string known = "tet";
  for (const std::string& other : baselineNames()) known += ", " + other;
  throw std::invalid_argument("this build has no tracker '" + name + "'; it has " + known +
                              (name == "lsd_lbd_knn" ? " (OpenCV came without line_descriptor)" : ""));
}

}  // namespace tet_line_tracker
