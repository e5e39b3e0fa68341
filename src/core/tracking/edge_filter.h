#pragma once

#include <array>

#include "tet_line_tracker/geometry/line_segment.h"
#include "tet_line_tracker/refinement/line_refiner.h"

namespace tet_line_tracker {

/// Where a line lies across itself, as the image before and the flow from there predict it.
struct EdgePrediction {
  LineSegment segment;              ///< [px]
  std::array<float, 3> noise_px{};  ///< EdgeFit::noise_px of the image before
  float flow_sigma_px{0.0F};        ///< deviation of what the flow adds, at each end [px]
};

/// Kalman update of the distances of both ends across a line: of what was predicted, by the fit to the edge.
/// A faint edge is measured with more noise than the flow adds from image to image, so that it gains from
/// those before; a clear one is where it is measured. What errs alike in all images is not taken for
/// averaged. A fit that is far from what was predicted is believed. `measured` comes back as it is when its
/// covariance or the prediction's is not known.
EdgeFit updateEdge(const EdgePrediction& predicted, const EdgeFit& measured);

}  // namespace tet_line_tracker
