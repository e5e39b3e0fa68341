#include "baseline_tracker.h"

#include <stdexcept>

#include "../track_measures.h"
#include "lk_endpoints.h"
#include "tracking/stopwatch.h"
#ifdef TET_HAVE_LINE_DESCRIPTOR
#include "lsd_lbd_knn.h"
#include "lsd_remapped.h"
#endif

namespace tet_line_tracker {

BaselineTracker::BaselineTracker(const LineTrackerParameters& parameters)
    : detection_(parameters.detection), frames_(parameters.stream) {}

FrameResult BaselineTracker::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  const StreamVerdict verdict = frames_.begin(gray, stamp_ns);
  if (isDropped(verdict)) return {verdict, nullptr};
  Stopwatch total;
  if (verdict == StreamVerdict::kNewEpoch) forget();
  track(gray);
  Stopwatch stage;
  normalizeEndpoints(camera_.get(), frame().lines);
  FrameStatistics& statistics = frame().statistics;
  statistics.undistort_ms += stage.lap();
  statistics.total_ms = total.lap();
  statistics.coverage = static_cast<float>(gridCoverage(frame()));
  return {verdict, &frame()};
}

TrackedLine BaselineTracker::newLine(const LineSegment& segment) {
  TrackedLine line;
  line.id = next_id_++;
  line.segment = segment;
  return line;
}

std::vector<std::string> baselineNames() {
  return {
#ifdef TET_HAVE_LINE_DESCRIPTOR
      "lsd_lbd_knn", "lsd_remapped",
#endif
      "lk_endpoints"};
}

std::unique_ptr<BaselineTracker> makeBaselineTracker(const std::string& name,
                                                     const LineTrackerParameters& parameters) {
#ifdef TET_HAVE_LINE_DESCRIPTOR
  if (name == "lsd_lbd_knn") return std::make_unique<LsdLbdKnn>(parameters);
  if (name == "lsd_remapped") return std::make_unique<LsdRemapped>(parameters);
#endif
  if (name == "lk_endpoints") return std::make_unique<LkEndpoints>(parameters);
  std::string known = "tet";
  for (const std::string& other : baselineNames()) known += ", " + other;
  throw std::invalid_argument("this build has no tracker '" + name + "'; it has " + known +
                              (name.rfind("lsd_", 0) == 0 ? " (OpenCV came without line_descriptor)" : ""));
}

}  // namespace tet_line_tracker
