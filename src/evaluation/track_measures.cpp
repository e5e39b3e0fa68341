#include "track_measures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <opencv2/core/utility.hpp>

#include "geometry/coverage_grid.h"
#include "homography_consensus.h"
#include "line_tracks.h"
#include "track_judge.h"

namespace tet_line_tracker {
namespace {

constexpr std::array<std::size_t, 4> kAges = TrackMeasures::kDriftAges;

/// What the truth says of one track.
struct TrackVerdict {
  std::vector<PairError> pairs;
  std::vector<double> drift;  ///< to the first image, entry 0 is the first image itself; NaN: not judged [px]
  std::vector<bool> covered;  ///< for the images after the first in which the first segment is in view
  std::size_t clean_length{1};
};

TrackVerdict judge(const LineTrack& track, const std::vector<LineFrame>& frames, const Truth& truth,
                   const MeasureOptions& options) {
  TrackVerdict verdict;
  const std::size_t count = track.lines.size();
  const auto stamp = [&](std::size_t i) { return frames[track.first_frame + i].stamp_ns; };
  const LiftedSegment first(truth, stamp(0), *track.lines[0]);

  verdict.drift.assign(count, 0.0);
  bool clean = true;
  for (std::size_t i = 1; i < count; ++i) {
    const TrackedLine& before = *track.lines[i - 1];
    const TrackedLine& after = *track.lines[i];
    const auto drift = first.errorOf(stamp(i), after);
    verdict.drift[i] = drift ? drift->absolute_px : TrackMeasures::kUnknown;
    clean = clean && !(verdict.drift[i] >= options.inlier_px);
    if (clean) verdict.clean_length = i + 1;

    PairError pair;
    pair.frame = track.first_frame + i - 1;
    pair.id = before.id;
    const auto error = i == 1 ? drift : LiftedSegment(truth, stamp(i - 1), before).errorOf(stamp(i), after);
    if (error) {
      pair.error = error->absolute_px;
      pair.normalized = error->signed_px / std::hypot(before.sigma_px, after.sigma_px);
    }
    verdict.pairs.push_back(pair);
  }

  for (std::size_t i = 1; track.first_frame + i < frames.size(); ++i) {
    if (stamp(i) <= stamp(i - 1) || !first.inView(stamp(i), options.min_length)) break;
    verdict.covered.push_back(i < count && verdict.drift[i] < options.inlier_px);
  }
  return verdict;
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return TrackMeasures::kUnknown;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Value below which a share of the values lies, by nearest rank.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return TrackMeasures::kUnknown;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double shareOf(std::size_t part, std::size_t whole) {
  return whole == 0 ? TrackMeasures::kUnknown : static_cast<double>(part) / static_cast<double>(whole);
}

void measureWithTruth(const std::vector<LineTrack>& tracks, const std::vector<LineFrame>& frames,
                      const Truth& truth, const MeasureOptions& options, TrackMeasures& measures) {
  std::vector<TrackVerdict> verdicts(tracks.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(tracks.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto index = static_cast<std::size_t>(i);
      verdicts[index] = judge(tracks[index], frames, truth, options);
    }
  });

  std::vector<double> errors;
  std::array<std::vector<double>, kAges.size()> drifts;
  std::vector<double> clean_lengths;
  std::vector<double> normalized;
  SurvivalCurve& curve = measures.survival_curve;
  for (const TrackVerdict& verdict : verdicts) {
    for (const PairError& pair : verdict.pairs) {
      measures.pairs.push_back(pair);
      if (std::isnan(pair.error)) {
        ++measures.unjudged_pairs;
        continue;
      }
      errors.push_back(pair.error);
      if (pair.error < options.inlier_px && std::isfinite(pair.normalized)) {
        normalized.push_back(pair.normalized);
      }
    }
    for (std::size_t n = 0; n < kAges.size(); ++n) {
      const std::size_t last = kAges[n] - 1;
      if (last < verdict.drift.size() && !std::isnan(verdict.drift[last])) {
        drifts[n].push_back(verdict.drift[last]);
      }
    }
    clean_lengths.push_back(static_cast<double>(verdict.clean_length));
    if (verdict.covered.size() > curve.in_view.size()) {
      curve.in_view.resize(verdict.covered.size(), 0);
      curve.covered.resize(verdict.covered.size(), 0);
    }
    for (std::size_t i = 0; i < verdict.covered.size(); ++i) {
      ++curve.in_view[i];
      if (verdict.covered[i]) ++curve.covered[i];
    }
  }

  measures.judged_pairs = errors.size();
  const auto below = [&](double limit) {
    return static_cast<std::size_t>(
        std::count_if(errors.begin(), errors.end(), [&](double error) { return error < limit; }));
  };
  measures.inlier_ratio = shareOf(below(options.inlier_px), errors.size());
  measures.tight_inlier_ratio = shareOf(below(options.tight_inlier_px), errors.size());
  measures.median_error = percentile(errors, 0.5);
  measures.p95_error = percentile(errors, 0.95);
  for (std::size_t n = 0; n < kAges.size(); ++n) {
    measures.drift[n] = percentile(drifts[n], 0.5);
    measures.drift_p95[n] = percentile(drifts[n], 0.95);
  }
  measures.clean_length = mean(clean_lengths);
  measures.survival = shareOf(std::accumulate(curve.covered.begin(), curve.covered.end(), std::size_t{0}),
                              std::accumulate(curve.in_view.begin(), curve.in_view.end(), std::size_t{0}));
  if (normalized.size() > 1) {
    double squares = 0.0;
    const double centre = mean(normalized);
    for (const double value : normalized) squares += (value - centre) * (value - centre);
    measures.sigma_spread = std::sqrt(squares / static_cast<double>(normalized.size() - 1));
  }
}

/// Adds the homography's verdict to the pairs, which come in any order.
void measureByHomography(const std::vector<LineTrack>& tracks, std::size_t images,
                         const MeasureOptions& options, TrackMeasures& measures) {
  struct ImagePair {
    std::vector<LineMatch> matches;
    std::vector<std::uint64_t> ids;
    std::vector<bool> inliers;
  };
  if (images < 2) return;
  std::vector<ImagePair> image_pairs(images - 1);
  for (const LineTrack& track : tracks) {
    for (std::size_t i = 1; i < track.lines.size(); ++i) {
      ImagePair& pair = image_pairs[track.first_frame + i - 1];
      pair.matches.push_back({track.lines[i - 1]->segment, track.lines[i]->segment});
      pair.ids.push_back(track.lines[i]->id);
    }
  }
  cv::parallel_for_(cv::Range(0, static_cast<int>(image_pairs.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      ImagePair& pair = image_pairs[static_cast<std::size_t>(i)];
      pair.inliers = homographyInliers(pair.matches, options.inlier_px);
    }
  });

  std::vector<double> counts;
  std::vector<double> ratios;
  std::vector<std::unordered_map<std::uint64_t, bool>> verdicts(image_pairs.size());
  for (std::size_t k = 0; k < image_pairs.size(); ++k) {
    const ImagePair& pair = image_pairs[k];
    counts.push_back(static_cast<double>(pair.matches.size()));
    if (pair.inliers.empty()) continue;
    ratios.push_back(static_cast<double>(std::count(pair.inliers.begin(), pair.inliers.end(), true)) /
                     static_cast<double>(pair.inliers.size()));
    for (std::size_t i = 0; i < pair.ids.size(); ++i) verdicts[k][pair.ids[i]] = pair.inliers[i];
  }
  measures.matches_per_pair = mean(counts);
  measures.homography_ratio = mean(ratios);
  if (measures.pairs.empty()) {
    for (std::size_t k = 0; k < image_pairs.size(); ++k) {
      for (const std::uint64_t id : image_pairs[k].ids) {
        PairError pair;
        pair.frame = k;
        pair.id = id;
        measures.pairs.push_back(pair);
      }
    }
  }
  for (PairError& pair : measures.pairs) {
    const auto verdict = verdicts[pair.frame].find(pair.id);
    pair.judged_by_homography = verdict != verdicts[pair.frame].end();
    pair.homography_inlier = pair.judged_by_homography && verdict->second;
  }
}

void measureTimes(const std::vector<LineFrame>& frames, TrackMeasures& measures) {
  const auto meanOf = [&](double FrameStatistics::*field) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const LineFrame& frame : frames) values.push_back(frame.statistics.*field);
    return mean(values);
  };
  std::vector<double> totals;
  totals.reserve(frames.size());
  for (const LineFrame& frame : frames) totals.push_back(frame.statistics.total_ms);
  measures.ms_mean = mean(totals);
  if (!std::isfinite(measures.ms_mean)) return;  // tracked without --times
  measures.ms_p99 = percentile(totals, 0.99);
  measures.pyramid_ms = meanOf(&FrameStatistics::pyramid_ms);
  measures.prior_ms = meanOf(&FrameStatistics::prior_ms);
  measures.flow_ms = meanOf(&FrameStatistics::flow_ms);
  measures.refine_ms = meanOf(&FrameStatistics::refine_ms);
  measures.detect_ms = meanOf(&FrameStatistics::detect_ms);
  measures.undistort_ms = meanOf(&FrameStatistics::undistort_ms);
}

}  // namespace

double gridCoverage(const LineFrame& frame, const LensBend& lens) {
  CoverageGrid grid(frame.width, frame.height);
  for (const TrackedLine& line : frame.lines) grid.add(lens.curve(line.segment));
  return static_cast<double>(grid.coverage());
}

TrackMeasures measureTracks(const std::vector<LineFrame>& frames, bool has_statistics, const Truth* truth,
                            const MeasureOptions& options) {
  TrackMeasures measures;
  measures.images = frames.size();
  if (frames.empty()) return measures;
  const std::vector<LineTrack> tracks = collectTracks(frames);
  measures.tracks = tracks.size();

  LensBend lens;
  if (truth != nullptr) {
    const std::shared_ptr<const CameraModel> not_owned(std::shared_ptr<void>(), &truth->camera());
    lens = LensBend(not_owned, frames.front().width, frames.front().height);
  }
  std::vector<double> coverages;
  std::size_t lines = 0;
  double lengths = 0.0;
  std::size_t detections = 0;
  for (const LineFrame& frame : frames) {
    lines += frame.lines.size();
    for (const TrackedLine& line : frame.lines) lengths += static_cast<double>(line.segment.length());
    detections += frame.detected ? 1 : 0;
    measures.lines.push_back(frame.lines.size());
    measures.seconds.push_back(1e-9 * static_cast<double>(frame.stamp_ns - frames.front().stamp_ns));
    coverages.push_back(gridCoverage(frame, lens));
  }
  measures.lines_per_image = shareOf(lines, frames.size());
  if (lines > 0) measures.line_length = lengths / static_cast<double>(lines);
  measures.track_length = shareOf(lines, tracks.size());
  measures.coverage = mean(coverages);
  measures.detections = shareOf(detections, frames.size());

  if (truth != nullptr) measureWithTruth(tracks, frames, *truth, options, measures);
  measureByHomography(tracks, frames.size(), options, measures);
  if (has_statistics) measureTimes(frames, measures);
  return measures;
}

}  // namespace tet_line_tracker
