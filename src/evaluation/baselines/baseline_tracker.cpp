#include "baseline_tracker.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <opencv2/core/version.hpp>

#include "../track_measures.h"
#include "edge_drawing_detector.h"
#include "lk_endpoints.h"
#include "tracking/stopwatch.h"
#ifdef TET_HAVE_LINE_DESCRIPTOR
#include "lbd_knn.h"
#include "remapped_lbd_knn.h"
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

namespace {

/// A detector as a part of a baseline.
struct Detector {
  const char* opencv_name;
  std::unique_ptr<LineDetector> (*make)();  ///< nullptr: it does not work with this OpenCV
};

std::unique_ptr<LineDetector> ifAvailable(const std::string& name) {
  const std::vector<std::string> available = availableDetectors();
  if (std::find(available.begin(), available.end(), name) == available.end()) return nullptr;
  return makeLineDetector(name);
}

constexpr Detector kLsd{"cv::LineSegmentDetector", [] { return ifAvailable("lsd"); }};
constexpr Detector kFld{"cv::ximgproc::FastLineDetector", [] { return ifAvailable("fld"); }};
constexpr Detector kEdgeDrawing{"cv::ximgproc::EdgeDrawing", makeEdgeDrawingDetector};

template <class Tracker>
std::unique_ptr<BaselineTracker> make(const LineTrackerParameters& parameters,
                                      std::unique_ptr<LineDetector> detector) {
  return std::make_unique<Tracker>(parameters, std::move(detector));
}
using Make = decltype(&make<LkEndpoints>);

// nullptr: this OpenCV has no LBD.
#ifdef TET_HAVE_LINE_DESCRIPTOR
constexpr Make kLbdKnn = make<LbdKnn>;
constexpr Make kRemappedLbdKnn = make<RemappedLbdKnn>;
#else
constexpr Make kLbdKnn = nullptr;
constexpr Make kRemappedLbdKnn = nullptr;
#endif

struct Baseline {
  const char* name;
  Detector detector;
  Make make;
};

constexpr Baseline kBaselines[] = {{"lsd_lbd_knn", kLsd, kLbdKnn},
                                   {"ed_lbd_knn", kEdgeDrawing, kLbdKnn},
                                   {"fld_lbd_knn", kFld, kLbdKnn},
                                   {"lsd_remapped", kLsd, kRemappedLbdKnn},
                                   {"lk_endpoints", kLsd, make<LkEndpoints>}};

bool works(const Baseline& baseline) {
  return baseline.make != nullptr && baseline.detector.make() != nullptr;
}

}  // namespace

std::vector<std::string> baselineNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Baseline& baseline : kBaselines) {
      if (works(baseline)) names.emplace_back(baseline.name);
    }
    return names;
  }();
  return kNames;
}

std::unique_ptr<BaselineTracker> makeBaselineTracker(const std::string& name,
                                                     const LineTrackerParameters& parameters) {
  std::string lack;
  for (const Baseline& baseline : kBaselines) {
    if (name != baseline.name) continue;
    if (works(baseline)) return baseline.make(parameters, baseline.detector.make());
    const char* const part = baseline.make == nullptr ? "cv::line_descriptor" : baseline.detector.opencv_name;
    lack = std::string(" (OpenCV " CV_VERSION " came without ") + part + ")";
  }
  std::string known = "tet";
  for (const std::string& other : baselineNames()) known += ", " + other;
  throw std::invalid_argument("this build has no tracker '" + name + "'; it has " + known + lack);
}

}  // namespace tet_line_tracker
