#include "tracking/track_table.h"

#include <utility>

#include "geometry/coverage_grid.h"

namespace tet_line_tracker {

LossReason lossOf(EndpointFlow::Status status) {
  switch (status) {
    case EndpointFlow::Status::kNoSolution:
      return LossReason::kFlow;
    case EndpointFlow::Status::kOutside:
      return LossReason::kBorder;
    case EndpointFlow::Status::kHighResidual:
      return LossReason::kResidual;
    case EndpointFlow::Status::kTracked:
      break;
  }
  return LossReason::kCount;
}

void TrackTable::add(const EdgeFit& edge, const LineBend& bend) {
  TrackedLine& line = lines_.emplace_back();
  line.id = next_id_++;
  line.segment = edge.segment;
  line.sigma_px = edge.sigma_px;
  line.covariance_px = edge.covariance_px;
  if (states_.size() < lines_.size()) states_.resize(lines_.size());
  TrackState& state = states_[lines_.size() - 1];
  state.contrast = edge.contrast;
  state.bend = bend;
  state.template_due = true;
  state.start_parallax.setZero();
  state.end_parallax.setZero();
  state.loss = LossReason::kCount;
}

void TrackTable::removeLost(FrameStatistics& statistics) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (states_[i].lost()) {
      ++statistics.lostFor(states_[i].loss);
      continue;
    }
    if (kept != i) {
      lines_[kept] = lines_[i];
      std::swap(states_[kept], states_[i]);
    }
    ++kept;
  }
  lines_.resize(kept);
  statistics.tracks_kept = static_cast<std::uint32_t>(kept);
}

void TrackTable::predictParallax() {
  // A part of it only, so that an error decays.
  constexpr float kDecay = 0.8F;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const LineSegment& found = lines_[i].segment;
    TrackState& state = states_[i];
    const Eigen::Vector2f normal = state.rotated.normal();
    state.start_parallax = -kDecay * found.distance(state.rotated.start) * normal;
    state.end_parallax = -kDecay * found.distance(state.rotated.end) * normal;
  }
}

float TrackTable::coverage(const cv::Size& size) const {
  CoverageGrid grid(size.width, size.height);
  for (std::size_t i = 0; i < lines_.size(); ++i) grid.add({lines_[i].segment, states_[i].bend});
  return grid.coverage();
}

}  // namespace tet_line_tracker
