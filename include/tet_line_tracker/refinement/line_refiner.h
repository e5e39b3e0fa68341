#pragma once

#include <array>
#include <limits>

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// A segment after the fit to the edge under it.
struct EdgeFit {
  LineSegment segment;   ///< start and end in their roles [px]
  float support{0.0F};   ///< share of the samples along the segment that lie on the edge, 0..1
  float contrast{0.0F};  ///< mean slope of the gray values across the edge, positive where the left side on
                         ///< screen is brighter [gray / px]
  /// Standard deviation of the position along the normal; NaN: too little support to tell [px]
  float sigma_px{std::numeric_limits<float>::quiet_NaN()};
  /// Covariance of the distances of start and end across the line: var(start), cov, var(end); NaN as sigma_px
  /// [px^2]
  std::array<float, 3> covariance_px{std::numeric_limits<float>::quiet_NaN(),
                                     std::numeric_limits<float>::quiet_NaN(),
                                     std::numeric_limits<float>::quiet_NaN()};
  /// The part of covariance_px that the fit in the next image will not repeat; NaN as sigma_px [px^2]
  std::array<float, 3> noise_px{std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::quiet_NaN()};
};

/// Puts a line on the edge under it: looks for the steepest place of the right polarity on profiles across
/// the line, which the lens may bend, fits offset and tilt through them that single wrong samples do not pull
/// away, and says how much of the line has an edge. Keeps endpoint flow from drifting. Const and thread-safe.
class LineRefiner {
 public:
  explicit LineRefiner(const LineRefinerParameters& parameters) : parameters_(parameters) {}

  /// Contrast of the edge under `line` as it lies, whose brighter side is to the left on screen, as detectors
  /// promise [gray / px]; 0: none. A stronger edge of the other polarity beside it does not count.
  float contrastOf(const cv::Mat& gray, const LineCurve& line) const;

  /// Fits `line` to the edge near it whose contrast has the sign and about the size of `contrast` [gray /
  /// px]. `gray`: 8-bit, one channel. A line with too little support comes back as it was, with its support;
  /// on fewer than four samples it has none.
  EdgeFit fit(const cv::Mat& gray, const LineCurve& line, float contrast) const;

  /// How far the edge that ends at the start of `ahead` goes on along it, from 0 to its length [px]. Pieces
  /// without an edge are bridged up to `max_gap` px, when the edge behind is twice as long.
  float reachOf(const cv::Mat& gray, const LineCurve& ahead, float contrast, float max_gap) const;

 private:
  LineRefinerParameters parameters_;
};

}  // namespace tet_line_tracker
