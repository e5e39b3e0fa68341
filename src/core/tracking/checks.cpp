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

bool LengthRatioCheck::passes(const VisibleArea&, TrackedLine&, const TrackState& state,
                              FrameStatistics&) const {
  const float ratio = state.followed.length() / state.predicted.length();
  return ratio < max_ratio_ && ratio * max_ratio_ > 1.0F;
}

bool AngleCheck::passes(const VisibleArea&, TrackedLine&, const TrackState& state, FrameStatistics&) const {
  return angleBetween(state.predicted, state.followed) <= max_rotation_;
}

bool SupportCheck::passes(const VisibleArea&, TrackedLine&, const TrackState& state, FrameStatistics&) const {
  return state.support >= min_support_;
}

bool EndpointsInImageCheck::passes(const VisibleArea& area, TrackedLine& line, const TrackState&,
                                   FrameStatistics&) const {
  return area.bounds().contains(line.segment.start) && area.bounds().contains(line.segment.end);
}

bool CutAtBorderCheck::passes(const VisibleArea& area, TrackedLine& line, const TrackState&,
                              FrameStatistics&) const {
  const std::optional<LineSegment> inside = clip(line.segment, area.bounds());
  if (!inside) return false;
  const bool cut = inside->length() != line.segment.length();
  line.segment = *inside;
  return !cut || inside->length() >= min_length_;
}

bool MinLengthCheck::passes(const VisibleArea&, TrackedLine& line, const TrackState&,
                            FrameStatistics&) const {
  return line.segment.length() >= min_length_;
}

bool FieldOfViewCheck::passes(const VisibleArea& area, TrackedLine& line, const TrackState&,
                              FrameStatistics& statistics) const {
  return area.cutToFieldOfView(min_length_, line.segment, statistics);
}

bool MaskCheck::passes(const VisibleArea& area, TrackedLine& line, const TrackState&,
                       FrameStatistics&) const {
  return area.mask().empty() || mostlyInMask(line.segment, area.mask());
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
    const LineSegment& segment = tracks.line(i).segment;
    if (older_.containsDuplicateOf(segment)) {
      tracks.state(i).loss = reason();
    } else {
      older_.add(segment);
    }
  }
}

}  // namespace tet_line_tracker
