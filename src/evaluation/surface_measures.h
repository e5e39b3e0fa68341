#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "scene_truth.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "track_measures.h"

namespace tet_line_tracker {

/// Tracks of lines on one kind of surface. Shares are 0..1; NaN: not known.
struct SurfaceMeasures {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  SurfaceKind kind{SurfaceKind::kSolid};
  std::size_t tracks{0};
  double line_share{kUnknown};    ///< of the lines of all images
  double track_length{kUnknown};  ///< images per track, mean
  double inlier_ratio{kUnknown};  ///< share of the pairs whose error is below the limit
};

/// One row per kind, in order. A track is on the kind on which most of its lines are, a line on that of most
/// of its points. `pairs`: errors of the same frames, as measureTracks() gives them.
std::vector<SurfaceMeasures> measureSurfaces(const std::vector<LineFrame>& frames, const SceneTruth& truth,
                                             const std::vector<PairError>& pairs, double inlier_px);

}  // namespace tet_line_tracker
