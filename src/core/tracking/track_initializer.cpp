#include "tracking/track_initializer.h"

#include <algorithm>

namespace tet_line_tracker {

TrackInitializer::TrackInitializer(const DetectionParameters& detection, const LineRefiner& refiner,
                                   const Options& options)
    : parameters_(detection),
      refiner_(refiner),
      options_(options),
      detector_(makeLineDetector(detection.detector, options.detectors)) {}

void TrackInitializer::addTracks(const cv::Mat& gray, const VisibleArea& area, TrackTable& tracks,
                                 FrameStatistics& statistics) {
  hints_.mask = area.mask();
  hints_.tracked.clear();
  taken_.clear();
  for (const TrackedLine& line : tracks.lines()) {
    hints_.tracked.push_back(line.segment);
    taken_.add(line.segment);
  }
  // More than there is room for, as some are no good; but not the whole of a rich image, which takes time.
  const std::size_t max_lines = static_cast<std::size_t>(parameters_.max_lines);
  const std::size_t tracked = tracks.size();
  hints_.enough =
      options_.spread ? 2 * (max_lines - std::min(max_lines, tracked)) + 20 : DetectionHints().enough;
  detector_->detect(gray, static_cast<float>(parameters_.min_length), candidates_, hints_);
  statistics.lines_detected = static_cast<std::uint32_t>(candidates_.size());

  auto next = [this, i = std::size_t{0}]() mutable -> const LineSegment* {
    if (options_.spread) return selector_.next();
    return i < candidates_.size() ? &candidates_[i++] : nullptr;
  };
  selector_.start(gray.cols, gray.rows, candidates_);
  for (const LineSegment& line : hints_.tracked) selector_.add(line);
  while (tracks.size() < max_lines) {
    const LineSegment* candidate = next();
    if (candidate == nullptr) break;
    // The cheap test before the fit, and again after it.
    if (taken_.containsDuplicateOf(*candidate)) continue;
    const std::optional<EdgeFit> edge = fitEdge(gray, area, *candidate, statistics);
    if (!edge || taken_.containsDuplicateOf(edge->segment)) continue;
    taken_.add(edge->segment);
    selector_.add(edge->segment);
    tracks.add(edge->segment, edge->contrast);
  }
  statistics.lines_added = static_cast<std::uint32_t>(tracks.size() - tracked);
}

std::optional<EdgeFit> TrackInitializer::fitEdge(const cv::Mat& gray, const VisibleArea& area,
                                                 const LineSegment& candidate,
                                                 FrameStatistics& statistics) const {
  EdgeFit edge;
  edge.segment = candidate;
  if (options_.fit_edges) {
    edge = refiner_.fit(gray, candidate, refiner_.contrastOf(gray, candidate));
    if (edge.support < parameters_.min_detection_support) return std::nullopt;
  }
  const std::optional<LineSegment> inside = clip(edge.segment, area.bounds(options_.margin_px));
  const auto min_length = static_cast<float>(parameters_.min_length);
  if (!inside || inside->length() < min_length + options_.margin_px) return std::nullopt;
  edge.segment = *inside;
  if (!area.cutToFieldOfView(min_length, edge.segment, statistics)) return std::nullopt;
  return edge;
}

}  // namespace tet_line_tracker
