#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "truth.h"

namespace tet_line_tracker {

struct MeasureOptions {
  double inlier_px{2.0};        ///< error below which a line is right [px]
  double tight_inlier_px{1.0};  ///< the same, stricter [px]
  double min_length{30.0};      ///< a segment shorter than this is no longer in view [px]
};

/// One line seen in two consecutive images.
struct PairError {
  std::size_t frame{0};  ///< index of the earlier image
  std::uint64_t id{0};
  /// Median distance of the moved points to the tracked line [px]; NaN: nothing to judge by.
  double error{std::numeric_limits<double>::quiet_NaN()};
  /// The same with sign, divided by the standard deviation that the two sigma_px promise; NaN: not given.
  double normalized{std::numeric_limits<double>::quiet_NaN()};
  bool judged_by_homography{false};
  bool homography_inlier{false};
};

/// Tracks against their age: entry i is about the image i images after the first.
struct SurvivalCurve {
  std::vector<std::size_t> in_view;  ///< tracks whose first segment is still in view
  std::vector<std::size_t> covered;  ///< of these, tracks that are there with a drift below the limit
};

/// What a stream of lines is worth. Shares are 0..1; NaN: not known.
struct TrackMeasures {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::array<std::size_t, 4> kDriftAges{5, 10, 20, 30};

  std::size_t images{0};
  std::size_t tracks{0};
  double lines_per_image{kUnknown};
  double coverage{kUnknown};      ///< share of the 8x6 grid crossed by a line, mean over images
  double line_length{kUnknown};   ///< of the lines in the raw image, mean [px]
  double track_length{kUnknown};  ///< images per track, mean

  /// Without truth.
  double matches_per_pair{kUnknown};  ///< lines seen in both of two consecutive images, mean
  double homography_ratio{kUnknown};  ///< share of these that agree on one homography, mean over image pairs
  double ms_mean{kUnknown}, ms_p99{kUnknown};  ///< per image, from the statistics
  double pyramid_ms{kUnknown}, prior_ms{kUnknown}, flow_ms{kUnknown}, refine_ms{kUnknown};
  double detect_ms{kUnknown}, undistort_ms{kUnknown};
  double detections{kUnknown};  ///< share of images on which the detector ran

  /// With truth.
  std::size_t judged_pairs{0};    ///< line pairs with an error
  std::size_t unjudged_pairs{0};  ///< line pairs of which no point could be followed by the truth
  double inlier_ratio{kUnknown}, tight_inlier_ratio{kUnknown};
  double median_error{kUnknown}, p95_error{kUnknown};  ///< frame to frame [px]
  std::array<double, kDriftAges.size()> drift{kUnknown, kUnknown, kUnknown, kUnknown};      ///< median [px]
  std::array<double, kDriftAges.size()> drift_p95{kUnknown, kUnknown, kUnknown, kUnknown};  ///< [px]
  double clean_length{kUnknown};  ///< images until the drift first passes the limit, mean
  double survival{kUnknown};  ///< share of the images in which a first segment is in view that are covered
  double sigma_spread{kUnknown};  ///< standard deviation of PairError::normalized over inliers; 1 is honest

  std::vector<PairError> pairs;
  SurvivalCurve survival_curve;
  std::vector<std::size_t> lines;  ///< per image
  std::vector<double> seconds;     ///< of each image since the first
};

/// Measures the lines of consecutive images. `truth` may be nullptr. `has_statistics`: the frames carry
/// times. The work is shared between threads; the result does not depend on their number.
TrackMeasures measureTracks(const std::vector<LineFrame>& frames, bool has_statistics, const Truth* truth,
                            const MeasureOptions& options = {});

/// Share of an 8x6 grid over the image that is crossed by a line of the frame, which `lens` may bend, 0..1.
double gridCoverage(const LineFrame& frame, const LensBend& lens = {});

}  // namespace tet_line_tracker
