#include "lk_endpoints.h"

#include <algorithm>
#include <utility>

#include <opencv2/video/tracking.hpp>

#include "geometry/segment_index.h"
#include "tracking/stopwatch.h"

namespace tet_line_tracker {
namespace {

const cv::Size kWindow(7, 7);
constexpr int kMaxLevel = 2;  // three images in the pyramid

}  // namespace

LkEndpoints::LkEndpoints(const LineTrackerParameters& parameters, std::unique_ptr<LineDetector> detector)
    : BaselineTracker(parameters),
      max_residual_(parameters.flow.max_residual),
      detector_(std::move(detector)) {}

void LkEndpoints::track(const cv::Mat& gray) {
  FrameStatistics& statistics = frame().statistics;
  Stopwatch stage;
  std::swap(pyramid_before_, pyramid_);
  cv::buildOpticalFlowPyramid(gray, pyramid_, kWindow, kMaxLevel);
  statistics.pyramid_ms = stage.lap();
  flow();
  statistics.tracks_kept = static_cast<std::uint32_t>(frame().lines.size());
  statistics.flow_ms = stage.lap();
  if (static_cast<int>(frame().lines.size()) < detection().min_lines) addLines(gray);
  statistics.detect_ms = stage.lap();
}

void LkEndpoints::flow() {
  std::vector<TrackedLine>& lines = frame().lines;
  if (lines.empty()) return;
  points_before_.clear();
  for (const TrackedLine& line : lines) {
    points_before_.emplace_back(line.segment.start.x(), line.segment.start.y());
    points_before_.emplace_back(line.segment.end.x(), line.segment.end.y());
  }
  const cv::TermCriteria ten_iterations(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 10, 0.01);
  cv::calcOpticalFlowPyrLK(pyramid_before_, pyramid_, points_before_, points_, found_, residuals_, kWindow,
                           kMaxLevel, ten_iterations);

  const ImageBounds bounds =
      ImageBounds::ofImage(frame().width, frame().height, static_cast<float>(detection().border));
  const auto count = [this](LossReason reason) { ++frame().statistics.lostFor(reason); };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t start = 2 * i;
    const std::size_t end = start + 1;
    const LineSegment segment{{points_[start].x, points_[start].y}, {points_[end].x, points_[end].y}};
    // OpenCV gives the mean absolute difference of gray values of 0..255.
    const float residual = std::max(residuals_[start], residuals_[end]) / 255.0F;
    if (found_[start] == 0 || found_[end] == 0) {
      count(LossReason::kFlow);
    } else if (residual > max_residual_) {
      count(LossReason::kResidual);
    } else if (!bounds.contains(segment.start) || !bounds.contains(segment.end)) {
      count(LossReason::kBorder);
    } else if (segment.length() < detection().min_length) {
      count(LossReason::kShort);
    } else {
      lines[kept] = lines[i];
      lines[kept].segment = segment;
      lines[kept].residual = residual;
      ++lines[kept].age;
      ++kept;
    }
  }
  lines.resize(kept);
}

void LkEndpoints::addLines(const cv::Mat& gray) {
  std::vector<TrackedLine>& lines = frame().lines;
  frame().detected = true;
  detector_->detect(gray, static_cast<float>(detection().min_length), candidates_);
  frame().statistics.lines_detected = static_cast<std::uint32_t>(candidates_.size());
  const ImageBounds bounds =
      ImageBounds::ofImage(frame().width, frame().height, static_cast<float>(detection().border));
  const std::size_t tracked = lines.size();
  const auto max_lines = static_cast<std::size_t>(detection().max_lines);
  SegmentIndex taken(DuplicateCriteria{});
  for (const TrackedLine& line : lines) taken.add(line.segment);
  for (const LineSegment& candidate : candidates_) {
    if (lines.size() >= max_lines) break;
    if (!bounds.contains(candidate.start) || !bounds.contains(candidate.end)) continue;
    if (taken.containsDuplicateOf(candidate)) continue;
    taken.add(candidate);
    lines.push_back(newLine(candidate));
  }
  frame().statistics.lines_added = static_cast<std::uint32_t>(lines.size() - tracked);
}

}  // namespace tet_line_tracker
