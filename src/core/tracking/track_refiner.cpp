#include "tracking/track_refiner.h"

#include <cmath>

#include "tracking/edge_filter.h"

namespace tet_line_tracker {
namespace {

/// A line that the border has just cut has shown less of itself to the flow: its edge must make up for it.
/// Over min_support.
constexpr float kCutSupport = 1.2F;

// Deviation of what the flow adds to the place of a line across itself [px].
constexpr float kFlowSigma = 0.15F;
constexpr float kStillSigma = 0.02F;  ///< of a line inside the dead band

}  // namespace

/// What lies outside shows no edge, and how far an edge is from the flow is known only where it is seen.
bool TrackRefiner::cutToImage(LineCurve& line, TrackState& state) const {
  const float whole = line.chord.length();
  const auto min_length = static_cast<float>(parameters_.detection.min_length);
  if (area_.cutToBounds(0.0F, line) && (line.chord.length() == whole || line.chord.length() >= min_length)) {
    return true;
  }
  state.loss = LossReason::kBorder;
  return false;
}

void TrackRefiner::refine(const cv::Mat& image, std::uint64_t number, TrackedLine& line,
                          TrackState& state) const {
  LineCurve curve = area_.lens().curve(line.segment);
  if (!cutToImage(curve, state)) return;
  EdgeFit fit = method_.refiner->fit(image, curve, state.contrast);
  const bool cut = curve.chord.length() < line.segment.length();
  if (cut && fit.support < kCutSupport * static_cast<float>(parameters_.refiner.min_support)) {
    state.loss = LossReason::kSupport;
    return;
  }
  state.bend = curve.bend;
  state.edge_offset = std::abs(fit.segment.distance(curve.chord.middle()));
  const LineSegment found = fit.segment;
  if (method_.grower && method_.grower->growTracked(image, area_, number, line, fit, state.bend)) {
    state.setGrown(found, fit.segment);
  } else {
    const float flow_sigma = state.template_due ? kFlowSigma : kStillSigma;
    fit = updateEdge({curve.chord, state.noise_px, flow_sigma}, fit);
  }
  state.noise_px = fit.noise_px;
  state.support = fit.support;
  state.contrast = fit.contrast;
  line.segment = fit.segment;
  line.sigma_px = fit.sigma_px;
  line.covariance_px = fit.covariance_px;
}

}  // namespace tet_line_tracker
