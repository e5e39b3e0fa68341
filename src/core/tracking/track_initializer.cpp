#include "tracking/track_initializer.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {
namespace {

/// An edge this steep stands out of any noise [gray / px]: where it has gaps, it has them in space. Rows of
/// small print are such edges, and are lost at once.
constexpr float kClearContrast = 20.0F;
constexpr double kClearGaps = 0.25;  ///< of the gaps that other edges may have

}  // namespace

TrackInitializer::TrackInitializer(const DetectionParameters& detection, const LineRefiner& refiner,
                                   const Options& options)
    : parameters_(detection),
      refiner_(refiner),
      grower_(refiner),
      options_(options),
      detector_(makeLineDetector(detection.detector, options.detectors)) {}

void TrackInitializer::addTracks(const cv::Mat& gray, const VisibleArea& area, TrackTable& tracks,
                                 FrameStatistics& statistics) {
  hints_.mask = area.mask();
  hints_.lens = &area.lens();
  hints_.tracked.clear();
  taken_.clear();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    hints_.tracked.emplace_back(tracks.line(i).segment, tracks.state(i).bend);
    taken_.add(hints_.tracked.back());
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
  for (const LineCurve& line : hints_.tracked) selector_.add(line.chord);
  while (tracks.size() < max_lines) {
    const LineSegment* candidate = next();
    if (candidate == nullptr) break;
    const LineCurve curve = area.lens().curve(*candidate);
    // The cheap test before the fit, and again after it.
    if (taken_.containsDuplicateOf(curve)) continue;
    const std::optional<NewLine> line = fitEdge(gray, area, curve, statistics);
    if (!line || taken_.containsDuplicateOf(line->curve())) continue;
    taken_.add(line->curve());
    selector_.add(line->edge.segment);
    tracks.add(line->edge, line->bend);
  }
  statistics.lines_added = static_cast<std::uint32_t>(tracks.size() - tracked);
}

bool TrackInitializer::isSupported(const EdgeFit& edge) const {
  const double max_gaps = 1.0 - parameters_.min_detection_support;
  const double gaps = 1.0 - static_cast<double>(edge.support);
  return gaps <= (std::abs(edge.contrast) < kClearContrast ? max_gaps : kClearGaps * max_gaps);
}

std::optional<TrackInitializer::NewLine> TrackInitializer::fitEdge(const cv::Mat& gray,
                                                                   const VisibleArea& area,
                                                                   const LineCurve& candidate,
                                                                   FrameStatistics& statistics) const {
  NewLine line;
  line.edge.segment = candidate.chord;
  if (options_.fit_edges) {
    line.edge = refiner_.fit(gray, candidate, refiner_.contrastOf(gray, candidate));
    if (!isSupported(line.edge)) return std::nullopt;
  }
  const auto min_length = static_cast<float>(parameters_.min_length);
  LineCurve inside(line.edge.segment, candidate.bend);
  if (!area.cutToBounds(options_.margin_px, inside)) return std::nullopt;
  line.edge.segment = inside.chord;
  if (options_.grow && grower_.grow(gray, area, options_.margin_px, line.edge, inside.bend)) {
    inside.chord = line.edge.segment;
  }
  if (inside.chord.length() < min_length + options_.margin_px) return std::nullopt;
  if (!area.cutToFieldOfView(min_length, inside, statistics)) return std::nullopt;
  line.edge.segment = inside.chord;
  line.bend = inside.bend;
  return line;
}

}  // namespace tet_line_tracker
