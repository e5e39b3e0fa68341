#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"
#include "tet_line_tracker/parameters/parameters.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tracking/track_table.h"
#include "tracking/tracking_method.h"
#include "tracking/visible_area.h"

namespace tet_line_tracker {

/// Moves one track to the edge under it, as far as that is seen better than it was predicted, and lets it
/// grow along that. For methods that have a refiner. Const: tracks are refined in parallel.
class TrackRefiner {
 public:
  TrackRefiner(const TrackingMethod& method, const VisibleArea& area, const LineTrackerParameters& parameters)
      : method_(method), area_(area), parameters_(parameters) {}

  /// `number`: of the image in its epoch. Sets what `state` knows of the edge, or why the track is lost.
  void refine(const cv::Mat& image, std::uint64_t number, TrackedLine& line, TrackState& state) const;

 private:
  bool cutToImage(LineCurve& line, TrackState& state) const;

  const TrackingMethod& method_;
  const VisibleArea& area_;
  const LineTrackerParameters& parameters_;
};

}  // namespace tet_line_tracker
