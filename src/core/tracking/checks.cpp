#include "tracking/checks.h"

#include <optional>

#include "image/mask.h"
#include "tracking/mad_threshold.h"

namespace tet_line_tracker {

void SingleTrackCheck::apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    TrackState& state = tracks.state(i);
    if (!state.lost() && !passes(area, tracks.line(i), state, statistics)) state.loss = reason();
  }
}

bool LengthRatioCheck::passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const {
  const float ratio = state.followed.length() / state.predicted.length();
  return ratio < max_ratio_ && ratio * max_ratio_ > 1.0F;
}

bool AngleCheck::passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const {
  return angleBetween(state.predicted, state.followed) <= max_rotation_;
}

bool SupportCheck::passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const {
  return state.support >= min_support_;
}

bool EndpointsInImageCheck::passes(const VisibleArea& area, TrackedLine& line, TrackState&,
                                   FrameStatistics&) const {
  return area.bounds().contains(line.segment.start) && area.bounds().contains(line.segment.end);
}

bool CutAtBorderCheck::passes(const VisibleArea& area, TrackedLine& line, TrackState& state,
                              FrameStatistics&) const {
  LineCurve curve(line.segment, state.bend);
  if (!area.cutToBounds(0.0F, curve)) return false;
  const bool cut = curve.chord.length() != line.segment.length();
  if (cut) line.forgetNormalized();
  line.segment = curve.chord;
  state.bend = curve.bend;
  return !cut || curve.chord.length() >= min_length_;
}

bool MinLengthCheck::passes(const VisibleArea&, TrackedLine& line, TrackState&, FrameStatistics&) const {
  return line.segment.length() >= min_length_;
}

bool FieldOfViewCheck::passes(const VisibleArea& area, TrackedLine& line, TrackState& state,
                              FrameStatistics& statistics) const {
  LineCurve curve(line.segment, state.bend);
  if (!area.cutToFieldOfView(min_length_, curve, statistics)) return false;
  if (curve.chord.start != line.segment.start || curve.chord.end != line.segment.end) line.forgetNormalized();
  line.segment = curve.chord;
  state.bend = curve.bend;
  return true;
}

bool MaskCheck::passes(const VisibleArea& area, TrackedLine& line, TrackState& state,
                       FrameStatistics&) const {
  return area.mask().empty() || mostlyInMask({line.segment, state.bend}, area.mask());
}

void DepthCheck::apply(const VisibleArea&, TrackTable& tracks, FrameStatistics& statistics) {
  if (statistics.translation_inliers < kMinInliers) return;
  std::size_t alive = 0;
  std::size_t conflicts = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks.state(i).lost()) continue;
    ++alive;
    if (tracks.state(i).depth_conflict) ++conflicts;
  }
  // Where many disagree, the motion may be wrong.
  if (5 * conflicts > alive) return;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    TrackState& state = tracks.state(i);
    if (!state.lost() && state.depth_conflict) state.loss = reason();
  }
}

void EdgeJumpCheck::apply(const VisibleArea&, TrackTable& tracks, FrameStatistics&) {
  offsets_.clear();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!tracks.state(i).lost()) offsets_.push_back(tracks.state(i).edge_offset);
  }
  const float threshold = madThreshold(offsets_, max_edge_offset_);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    TrackState& state = tracks.state(i);
    if (!state.lost() && state.edge_offset > threshold) state.loss = reason();
  }
}

void DuplicateCheck::apply(const VisibleArea&, TrackTable& tracks, FrameStatistics&) {
  older_.clear();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks.state(i).lost()) continue;
    const LineCurve line(tracks.line(i).segment, tracks.state(i).bend);
    if (older_.containsDuplicateOf(line)) {
      tracks.state(i).loss = reason();
    } else {
      older_.add(line);
    }
  }
}

}  // namespace tet_line_tracker
