#include "tracking/track_table.h"

#include <utility>

#include "geometry/coverage_grid.h"

namespace tet_line_tracker {

namespace {

/// Of the movement across a line: by the fits in both images, and by the rotation [px].
constexpr double kMovementSigma = 0.4;
/// A line must contradict its depth by more than this [px].
constexpr double kMaxConflict = 3.0;

}  // namespace

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

void TrackState::setGrown(const LineSegment& before, const LineSegment& after) {
  template_due = true;
  const float length = before.length();
  rotated = {rotated.at(before.along(after.start) / length), rotated.at(before.along(after.end) / length)};
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
  state.noise_px = edge.noise_px;
  state.template_due = true;
  state.start_parallax.setZero();
  state.end_parallax.setZero();
  state.depth.known = false;
  state.depth_conflict = false;
  state.loss = LossReason::kCount;
}

void TrackTable::removeLost(LineFrame& frame) {
  FrameStatistics& statistics = frame.statistics;
  // All may be lost at once: that should cost no memory then.
  frame.lost.reserve(lines_.capacity());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (states_[i].lost()) {
      ++statistics.lostFor(states_[i].loss);
      frame.lost.push_back({lines_[i].id, states_[i].loss});
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

void TrackTable::measureDepths(const MotionPrediction& motion, double focal) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    TrackState& state = states_[i];
    state.step.start_now = lines_[i].start_normalized;
    state.step.end_now = lines_[i].end_normalized;
    state.depth_conflict = false;
    if (!motion.translates() || !state.step.valid()) {
      state.depth.known = false;
      continue;
    }
    const LineDepth measured = measureDepth(state.step, motion.translation, kMovementSigma / focal);
    state.depth_conflict =
        contradicts(measured, state.expected_depth, state.depth.known, kMaxConflict / focal);
    state.depth = movedTo(state.step, fused(state.expected_depth, measured), motion.translation);
  }
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

void TrackTable::forgetParallax() {
  for (TrackState& state : states_) state.start_parallax = state.end_parallax = Eigen::Vector2f::Zero();
}

float TrackTable::coverage(const cv::Size& size) const {
  CoverageGrid grid(size.width, size.height);
  for (std::size_t i = 0; i < lines_.size(); ++i) grid.add({lines_[i].segment, states_[i].bend});
  return grid.coverage();
}

}  // namespace tet_line_tracker
