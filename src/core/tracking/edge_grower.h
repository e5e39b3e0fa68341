#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tracking/visible_area.h"

namespace tet_line_tracker {

/// Lets lines grow along their edges, as the lens bends them: over small gaps, to the end of the edge or of
/// what is visible. A line that grows over other pieces of its edge makes them duplicates. Const and
/// thread-safe.
class EdgeGrower {
 public:
  explicit EdgeGrower(const LineRefiner& refiner) : refiner_(refiner) {}

  /// Grows a new line at both ends, to at most a few times its length, and no nearer than `margin` px to the
  /// bounds. `edge`, which is fitted again as a whole, and `bend` change together; false: not at all.
  bool grow(const cv::Mat& gray, const VisibleArea& area, float margin, EdgeFit& edge, LineBend& bend) const;

  /// The same for a tracked line that was found as `edge` in image number `image`: ends that were cut in the
  /// image before, and in every fourth image both.
  bool growTracked(const cv::Mat& gray, const VisibleArea& area, std::uint64_t image, const TrackedLine& line,
                   EdgeFit& edge, LineBend& bend) const;

 private:
  /// By up to half its length at each of `ends` (LineCut bits).
  bool growOnce(const cv::Mat& gray, const VisibleArea& area, float margin, unsigned ends, EdgeFit& edge,
                LineBend& bend) const;
  /// A cheap look beyond an end along the tangent: whether half of the way at least has the edge. The
  /// brighter side is to the left of the line, as of all that detectors find.
  bool mayGoOn(const cv::Mat& gray, const LineCurve& line, bool at_end, float contrast) const;
  /// Where the edge ends beyond the end of `line`; that end itself when it does not go on.
  Eigen::Vector2f endOfEdge(const cv::Mat& gray, const VisibleArea& area, float margin,
                            const LineSegment& line, float contrast) const;

  LineRefiner refiner_;
};

}  // namespace tet_line_tracker
