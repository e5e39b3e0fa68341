#include "lbd_knn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "tracking/stopwatch.h"

namespace tet_line_tracker {
namespace {

// The usual ratio test of the two nearest (Lowe).
constexpr float kMaxRatio = 0.8F;

cv::line_descriptor::KeyLine keyLineOf(const LineSegment& segment, int index, const cv::Mat& gray) {
  cv::line_descriptor::KeyLine line;
  const Eigen::Vector2f along = segment.end - segment.start;
  line.angle = std::atan2(along.y(), along.x());
  line.class_id = index;
  line.octave = 0;
  line.pt = {segment.middle().x(), segment.middle().y()};
  line.lineLength = segment.length();
  line.response = line.lineLength / static_cast<float>(std::max(gray.cols, gray.rows));
  line.size = along.x() * along.y();
  line.startPointX = line.sPointInOctaveX = segment.start.x();
  line.startPointY = line.sPointInOctaveY = segment.start.y();
  line.endPointX = line.ePointInOctaveX = segment.end.x();
  line.endPointY = line.ePointInOctaveY = segment.end.y();
  line.numOfPixels = cv::LineIterator(gray, line.getStartPoint(), line.getEndPoint()).count;
  return line;
}

}  // namespace

LbdKnn::LbdKnn(const LineTrackerParameters& parameters, std::unique_ptr<LineDetector> detector)
    : BaselineTracker(parameters),
      detector_(std::move(detector)),
      describer_(cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor()),
      matcher_(cv::NORM_HAMMING) {
  describer_->setNumOfOctaves(1);
}

void LbdKnn::track(const cv::Mat& gray) {
  FrameStatistics& statistics = frame().statistics;
  Stopwatch stage;
  detector_->detect(gray, static_cast<float>(detection().min_length), segments_);
  segments_.erase(std::remove_if(segments_.begin(), segments_.end(),
                                 [this](const LineSegment& segment) { return !isWanted(segment); }),
                  segments_.end());
  frame().detected = true;
  statistics.lines_detected = static_cast<std::uint32_t>(segments_.size());
  statistics.detect_ms = stage.lap();

  cv::Mat descriptors;
  std::vector<cv::line_descriptor::KeyLine> key_lines;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    key_lines.push_back(keyLineOf(segments_[i], static_cast<int>(i), gray));
  }
  if (!key_lines.empty()) describer_->compute(gray, key_lines, descriptors);
  statistics.refine_ms = stage.lap();

  const std::vector<int> partners = match(descriptors);
  std::vector<TrackedLine> lines;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (partners[i] < 0) {
      lines.push_back(newLine(segments_[i]));
      continue;
    }
    TrackedLine line = frame().lines[static_cast<std::size_t>(partners[i])];
    line.segment = segments_[i];
    ++line.age;
    lines.push_back(line);
    ++statistics.tracks_kept;
  }
  statistics.lines_added = static_cast<std::uint32_t>(lines.size()) - statistics.tracks_kept;
  statistics.lostFor(LossReason::kFlow) = statistics.tracks_before - statistics.tracks_kept;

  // Oldest first, and the descriptors in the same order.
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&lines](std::size_t a, std::size_t b) { return lines[a].id < lines[b].id; });
  frame().lines.clear();
  descriptors_before_.release();
  for (const std::size_t index : order) {
    frame().lines.push_back(lines[index]);
    descriptors_before_.push_back(descriptors.row(static_cast<int>(index)));
  }
  statistics.flow_ms = stage.lap();
}

std::vector<int> LbdKnn::match(const cv::Mat& descriptors) const {
  std::vector<int> partners(segments_.size(), -1);
  if (descriptors.empty() || descriptors_before_.rows < 2) return partners;
  std::vector<std::vector<cv::DMatch>> nearest;
  matcher_.knnMatch(descriptors, descriptors_before_, nearest, 2);
  // An id can go on in one line only: the nearest one gets it.
  struct Claim {
    int line{-1};
    float distance{std::numeric_limits<float>::max()};
  };
  std::vector<Claim> claims(static_cast<std::size_t>(descriptors_before_.rows));
  for (const std::vector<cv::DMatch>& two : nearest) {
    if (two.size() < 2 || two[0].distance >= kMaxRatio * two[1].distance) continue;
    Claim& claim = claims[static_cast<std::size_t>(two[0].trainIdx)];
    if (two[0].distance < claim.distance) claim = {two[0].queryIdx, two[0].distance};
  }
  for (std::size_t before = 0; before < claims.size(); ++before) {
    if (claims[before].line >= 0) {
      partners[static_cast<std::size_t>(claims[before].line)] = static_cast<int>(before);
    }
  }
  return partners;
}

}  // namespace tet_line_tracker
