#include "true_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace tet_line_tracker {
namespace {

constexpr float kBorder =
    2.0F;  // lines end there, so that their noise does not move them out of the picture [px]
constexpr double kStep = 0.05;  // between the points of an edge at which visibility is asked for [m]

/// Longest stretch of an edge that is in the picture and not hidden, in pixels of the raw image.
std::optional<LineSegment> visiblePart(const SceneTruth& truth, const TrueEdge& edge, std::int64_t stamp_ns,
                                       const Eigen::Isometry3d& camera_from_world) {
  const CameraModel& camera = truth.camera();
  const auto bounds = ImageBounds::ofImage(camera.calibration().width, camera.calibration().height, kBorder);
  const int steps = std::max(2, static_cast<int>(std::ceil((edge.end - edge.start).norm() / kStep)));
  std::optional<LineSegment> longest;
  LineSegment part;
  bool inside = false;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector3d point = edge.start + static_cast<double>(i) / steps * (edge.end - edge.start);
    const auto pixel = camera.project(camera_from_world * point);
    const bool visible = pixel && bounds.contains(pixel->cast<float>()) && camera.normalize(*pixel) &&
                         !truth.isHidden(point, stamp_ns);
    if (visible) {
      part.end = pixel->cast<float>();
      if (!inside) part.start = part.end;
      if (!longest || part.length() > longest->length()) longest = part;
    }
    inside = visible;
  }
  return longest;
}

void check(const TrueLinesOptions& options) {
  if (options.max_lines < 1) {
    throw std::invalid_argument("max_lines is " + std::to_string(options.max_lines) + ", needs 1 or more");
  }
  if (!(options.noise_px >= 0.0)) {
    throw std::invalid_argument("noise is " + std::to_string(options.noise_px) + " px, needs 0 or more");
  }
}

}  // namespace

TrueLines::TrueLines(const SceneTruth& truth, const TrueLinesOptions& options)
    : truth_(truth), options_(options), random_(options.seed, 11) {
  check(options);
}

LineFrame TrueLines::next(std::int64_t stamp_ns) {
  const CameraModel& camera = truth_.camera();
  LineFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.image_count = ++image_count_;
  frame.width = camera.calibration().width;
  frame.height = camera.calibration().height;
  const auto world_from_camera = truth_.worldFromCamera(stamp_ns);
  if (!world_from_camera) {
    tracks_.clear();
    return frame;
  }
  const Eigen::Isometry3d camera_from_world = world_from_camera->inverse();

  struct Seen {
    std::size_t edge;
    bool known;
    LineSegment segment;
  };
  std::vector<Seen> seen;
  const std::vector<TrueEdge>& edges = truth_.edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto segment = visiblePart(truth_, edges[i], stamp_ns, camera_from_world);
    if (!segment || segment->length() < options_.min_length_px) continue;
    seen.push_back({i, tracks_.count(i) > 0, *segment});
  }
  std::stable_sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) {
    return a.known != b.known ? a.known : a.segment.length() > b.segment.length();
  });
  if (seen.size() > static_cast<std::size_t>(options_.max_lines)) {
    seen.resize(static_cast<std::size_t>(options_.max_lines));
  }

  std::unordered_map<std::size_t, Track> tracks;
  for (const Seen& each : seen) {
    const auto known = tracks_.find(each.edge);
    const Track track =
        known == tracks_.end() ? Track{next_id_++, 1} : Track{known->second.id, known->second.age + 1};
    tracks.emplace(each.edge, track);
    const Eigen::Vector2f along = each.segment.direction();
    const Eigen::Vector2f across(-along.y(), along.x());
    const auto noisy = [&](const Eigen::Vector2f& end) {
      return Eigen::Vector2f(end + static_cast<float>(options_.noise_px * random_.normal()) * across);
    };
    TrackedLine line;
    line.id = track.id;
    line.age = track.age;
    if (track.age > 1) line.residual = 0.0F;
    line.segment.start = noisy(each.segment.start);
    line.segment.end = noisy(each.segment.end);
    const auto start = camera.normalize(line.segment.start.cast<double>());
    const auto end = camera.normalize(line.segment.end.cast<double>());
    if (!start || !end) {
      tracks.erase(each.edge);
      continue;
    }
    line.start_normalized = *start;
    line.end_normalized = *end;
    const auto variance = static_cast<float>(options_.noise_px * options_.noise_px);
    line.covariance_px = {variance, 0.0F, variance};
    line.sigma_px = std::sqrt(0.5F * variance);
    frame.lines.push_back(line);
  }
  tracks_ = std::move(tracks);
  std::sort(frame.lines.begin(), frame.lines.end(),
            [](const TrackedLine& a, const TrackedLine& b) { return a.id < b.id; });
  return frame;
}

}  // namespace tet_line_tracker
