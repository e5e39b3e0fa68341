#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "detection/candidate_selector.h"
#include "geometry/segment_index.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "tet_line_tracker/parameters/parameters.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tracking/edge_grower.h"
#include "tracking/track_table.h"
#include "tracking/visible_area.h"

namespace tet_line_tracker {

/// Detects lines in an image and starts tracks on the best of those that are not tracked yet. Not
/// thread-safe.
class TrackInitializer {
 public:
  struct Options {
    /// New lines are fitted to their edges; those with too little support are left out.
    bool fit_edges{true};
    /// New lines grow along their edges beyond what the detector found; needs fit_edges.
    bool grow{true};
    /// New lines by CandidateSelector; otherwise the longest first.
    bool spread{true};
    /// For detector `auto`: the detectors to try, best first.
    std::vector<std::string> detectors{"edge", "lsd", "fld"};
    /// New lines are this much longer than min_length and farther inside the border: otherwise noise would
    /// soon end them [px].
    float margin_px{2.0F};
  };
  /// Throws std::invalid_argument when the detector is not available.
  TrackInitializer(const DetectionParameters& detection, const LineRefiner& refiner, const Options& options);

  /// Adds tracks until there are max_lines; fills in lines_detected and lines_added.
  void addTracks(const cv::Mat& gray, const VisibleArea& area, TrackTable& tracks,
                 FrameStatistics& statistics);

  std::string detectorName() const { return detector_->name(); }

 private:
  /// The edge under a detected line, when enough of it can be tracked, and its bend by the lens.
  struct NewLine {
    EdgeFit edge;
    LineBend bend;
    LineCurve curve() const { return {edge.segment, bend}; }
  };
  /// Whether enough of a new line lies on an edge.
  bool isSupported(const EdgeFit& edge) const;
  std::optional<NewLine> fitEdge(const cv::Mat& gray, const VisibleArea& area, const LineCurve& candidate,
                                 FrameStatistics& statistics) const;

  DetectionParameters parameters_;
  LineRefiner refiner_;
  EdgeGrower grower_;
  Options options_;
  std::unique_ptr<LineDetector> detector_;
  DetectionHints hints_;
  std::vector<LineSegment> candidates_;
  CandidateSelector selector_;
  SegmentIndex taken_{DuplicateCriteria{}};  ///< tracked lines and new ones
};

}  // namespace tet_line_tracker
