#include "tracking/track_follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

/// Where the place of a line across itself is less sure than this, it is searched along its way [px].
constexpr double kSurePx = 3.0;
/// From one place of the search to the next; the flow reaches twice as far [px].
constexpr float kSearchStepPx = 6.0F;
/// The search covers this many deviations of the expected inverse depth.
constexpr double kSearchDeviations = 3.0;
/// A place that was not expected must fit this much better than the one that was.
constexpr float kMinLead = 0.8F;

/// The bend of `before` at `moved`, when this is so near that it is the same but for the length, to about
/// 0.02 px.
std::optional<LineBend> bendNearby(const LineCurve& before, const LineSegment& moved) {
  constexpr float kFar = 4.0F;  // [px^2], of sagitta and way: bends change over a focal length or so
  const float sagitta = 0.25F * (std::abs(before.bend.c[0]) + std::abs(before.bend.c[1]));
  const float way =
      std::max((moved.start - before.chord.start).norm(), (moved.end - before.chord.end).norm());
  if (!(sagitta * way < kFar)) return std::nullopt;
  const float stretch = moved.length() / before.chord.length();
  LineBend bend = before.bend;
  for (float& coefficient : bend.c) coefficient *= stretch * stretch;
  return bend;
}

}  // namespace

LineBend TrackFollower::bendOf(const TrackedLine& line, const TrackState& state) const {
  if (area_.lens().isStraight() || !line.start_normalized.allFinite() || !line.end_normalized.allFinite()) {
    return {};
  }
  if (const auto nearby = bendNearby({line.segment, state.bend}, state.rotated)) return *nearby;
  return area_.lens().between(state.rotated, state.step.start_before, state.step.end_before);
}

LineDepth TrackFollower::expectDepth(const MotionPrediction& motion, const TrackedLine& line,
                                     const TrackState& state) const {
  LineDepth depth;
  if (!motion.translates() || !state.step.start_before.allFinite() || !state.step.end_before.allFinite()) {
    return depth;
  }
  if (state.depth.known && motion.step_ratio > 0.0) return state.depth.inUnitOf(motion.step_ratio);
  const std::optional<DepthGuess> start = prior_.depthNear(line.segment.start);
  const std::optional<DepthGuess> end = prior_.depthNear(line.segment.end);
  if (!start || !end) return depth;
  depth.known = true;
  depth.inverse = {start->inverse, end->inverse};
  depth.variance = {start->variance, end->variance};
  return depth;
}

bool TrackFollower::isSure(const MotionPrediction& motion, const LineDepth& depth,
                           const TrackState& state) const {
  if (!motion.translates()) return motion.confirmed;
  if (!depth.known) return false;
  const Eigen::Vector2d across = sensitivityOf(state.step, depth.inverse, motion.translation).across;
  const Eigen::Vector2d deviations = depth.variance.cwiseSqrt().cwiseProduct(across.cwiseAbs());
  return prior_.focal() * deviations.maxCoeff() < kSurePx;
}

LinePath TrackFollower::pathOf(const MotionPrediction& motion, const TrackedLine& line,
                               const LineDepth& depth) const {
  LinePath path;
  const auto at = [&](double inverse) {
    return prior_.apply(motion, line.segment, line.start_normalized, line.end_normalized,
                        Eigen::Vector2d::Constant(inverse));
  };
  double farthest = std::max(depth.inverse[0] + kSearchDeviations * std::sqrt(depth.variance[0]),
                             depth.inverse[1] + kSearchDeviations * std::sqrt(depth.variance[1]));
  const LineSegment first = at(0.0);
  const LineSegment last = at(farthest);
  const Eigen::Vector2f normal = first.normal();
  const float way =
      std::max(std::abs(normal.dot(last.start - first.start)), std::abs(normal.dot(last.end - first.end)));
  const auto most = static_cast<float>(LinePath::kMaxSteps - 1);
  float steps = std::ceil(way / kSearchStepPx);
  if (!(steps >= 1.0F)) steps = 1.0F;
  if (steps > most) {
    farthest *= static_cast<double>(most / steps);
    steps = most;
  }
  path.count = static_cast<std::size_t>(steps) + 1;
  for (std::size_t k = 0; k < path.count; ++k) {
    path.chords[k] = at(farthest * static_cast<double>(k) / static_cast<double>(path.count - 1));
  }
  path.expected = static_cast<std::size_t>(
      std::clamp(static_cast<double>(steps) * 0.5 * depth.inverse.sum() / std::max(1e-12, farthest), 0.0,
                 static_cast<double>(steps)));
  return path;
}

void TrackFollower::follow(const MotionPrediction& motion, const ImagePyramid& pyramid, TrackedLine& line,
                           TrackState& state) const {
  const EndpointFlow flow = findLine(motion, pyramid, line, state);
  state.loss = lossOf(flow.status);
  if (state.lost()) return;
  // Inside the dead band a line keeps its ends, which noise would otherwise let wander along it.
  const float moved = std::max((flow.segment.start - state.reference.start).norm(),
                               (flow.segment.end - state.reference.end).norm());
  state.template_due = moved >= method_.dead_band_px || flow.residual > method_.max_kept_residual;
  if (state.template_due) line.segment = flow.segment;
  state.followed = line.segment;
  line.residual = flow.residual;
  ++line.age;
}

void TrackFollower::renewTemplate(const ImagePyramid& pyramid, const TrackedLine& line,
                                  TrackState& state) const {
  if (!state.template_due) {
    // The image it is of is gone with the next one.
    method_.flow->extendTemplate(pyramid_before_, state.patches);
    return;
  }
  state.reference = line.segment;
  method_.flow->extractTemplate(pyramid, {state.reference, state.bend}, state.patches,
                                EndpointTracker::Reach::kNear);
}

EndpointFlow TrackFollower::findLine(const MotionPrediction& motion, const ImagePyramid& pyramid,
                                     const TrackedLine& line, TrackState& state) const {
  state.step.start_before = motion.rotation * line.start_normalized.homogeneous();
  state.step.end_before = motion.rotation * line.end_normalized.homogeneous();
  state.rotated = prior_.apply(motion, line.segment, line.start_normalized, line.end_normalized);
  state.expected_depth = expectDepth(motion, line, state);
  const LineBend bend = bendOf(line, state);
  state.predicted =
      state.expected_depth.known
          ? prior_.apply(motion, line.segment, line.start_normalized, line.end_normalized,
                         state.expected_depth.inverse)
          : LineSegment{state.rotated.start + state.start_parallax, state.rotated.end + state.end_parallax};
  const LineCurve expected(state.predicted, bend);
  if (isSure(motion, state.expected_depth, state)) {
    EndpointFlow near = method_.flow->track(state.patches, pyramid, expected, EndpointTracker::Reach::kNear);
    if (near.status == EndpointFlow::Status::kTracked) return near;
  }
  method_.flow->extendTemplate(pyramid_before_, state.patches);
  EndpointFlow best = method_.flow->track(state.patches, pyramid, expected);
  if (!state.expected_depth.known) return best;
  LinePath path = pathOf(motion, line, state.expected_depth);
  path.bend = bend;
  std::array<LineSegment, EndpointTracker::kMaxStarts> starts;
  const std::size_t count = method_.flow->search(state.patches, pyramid, path, starts);
  for (std::size_t k = 0; k < count; ++k) {
    const EndpointFlow flow = method_.flow->track(state.patches, pyramid, {starts[k], bend});
    if (flow.status != EndpointFlow::Status::kTracked) continue;
    if (best.status == EndpointFlow::Status::kTracked && !(flow.residual < kMinLead * best.residual))
      continue;
    best = flow;
    state.predicted = starts[k];
  }
  return best;
}

}  // namespace tet_line_tracker
