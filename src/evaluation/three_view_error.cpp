#include "three_view_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "line_tracks.h"
#include "undistorted_line.h"

namespace tet_line_tracker {
namespace {

constexpr double kStep = 0.1;  // of the ends of the last view, for the derivative [px]

/// Rays of a line's ends, with the pixels and normals where the line ends in the raw image.
struct Ends {
  std::array<Eigen::Vector2d, 2> pixel, normal;
  std::array<Eigen::Vector3d, 2> ray;
};

std::optional<Ends> endsOf(const CameraModel& camera, const TrackedLine& line) {
  const UndistortedLine undistorted(camera, line);
  Ends ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto sample = undistorted.at(static_cast<double>(i));
    if (!sample) return std::nullopt;
    const auto ray = camera.unproject(sample->pixel);
    if (!ray) return std::nullopt;
    ends.pixel[i] = sample->pixel;
    ends.normal[i] = sample->normal;
    ends.ray[i] = *ray;
  }
  return ends;
}

/// A plane through the centre of a camera, in the frame of the middle one: normal.dot(x) + offset = 0.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

Plane planeOf(const Eigen::Isometry3d& middle_from_camera, const Eigen::Vector3d& start,
              const Eigen::Vector3d& end) {
  const Eigen::Vector3d normal = middle_from_camera.linear() * start.cross(end).normalized();
  return {normal, -normal.dot(middle_from_camera.translation())};
}

/// Signed distances of the middle line's ends from where the line of both planes appears [px].
std::optional<Eigen::Vector2d> distances(const CameraModel& camera, const Plane& first, const Plane& last,
                                         const Ends& middle) {
  // The plane of the pencil that goes through the middle camera's centre.
  const Eigen::Vector3d normal = last.offset * first.normal - first.offset * last.normal;
  const double length = normal.norm();
  if (!(length > 1e-12)) return std::nullopt;
  Eigen::Vector2d result;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto distance = imageDistance(camera, normal / length, middle.ray[i]);
    if (!distance) return std::nullopt;
    result(static_cast<Eigen::Index>(i)) = *distance;
  }
  return result;
}

double shareOf(std::size_t part, std::size_t whole) {
  if (whole == 0) return ThreeViewMeasures::kUnknown;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<ThreeViewError> threeViewError(const CameraModel& camera,
                                             const std::array<Eigen::Isometry3d, 3>& world_from_camera,
                                             const std::array<const TrackedLine*, 3>& lines) {
  const auto first_ends = endsOf(camera, *lines[0]);
  const auto middle_ends = endsOf(camera, *lines[1]);
  const auto last_ends = endsOf(camera, *lines[2]);
  if (!first_ends || !middle_ends || !last_ends) return std::nullopt;
  const Eigen::Isometry3d middle_from_world = world_from_camera[1].inverse();
  const Eigen::Isometry3d middle_from_last = middle_from_world * world_from_camera[2];
  const Plane first =
      planeOf(middle_from_world * world_from_camera[0], first_ends->ray[0], first_ends->ray[1]);
  const auto withLast = [&](const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
    return distances(camera, first, planeOf(middle_from_last, start, end), *middle_ends);
  };
  const auto seen = withLast(last_ends->ray[0], last_ends->ray[1]);
  if (!seen) return std::nullopt;

  Eigen::Vector2d movement = Eigen::Vector2d::Zero();  // of the projection at both ends, per px
  for (std::size_t i = 0; i < 2; ++i) {
    std::array<Eigen::Vector2d, 2> moved;
    for (std::size_t side = 0; side < 2; ++side) {
      const double step = side == 0 ? -kStep : kStep;
      const auto ray = camera.unproject(last_ends->pixel[i] + step * last_ends->normal[i]);
      if (!ray) return std::nullopt;
      const auto there = i == 0 ? withLast(*ray, last_ends->ray[1]) : withLast(last_ends->ray[0], *ray);
      if (!there) return std::nullopt;
      moved[side] = *there;
    }
    movement += (moved[1] - moved[0]).cwiseAbs() / (2.0 * kStep);
  }
  ThreeViewError result{};
  result.sensitivity = movement.maxCoeff();
  result.error_px = seen->cwiseAbs().maxCoeff() / std::max(1.0, result.sensitivity);
  return result;
}

ThreeViewMeasures measureThreeViews(const std::vector<LineFrame>& frames, const PoseTrack& world_from_camera,
                                    const CameraModel& camera, double inlier_px, double tight_inlier_px) {
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  poses.reserve(frames.size());
  for (const LineFrame& frame : frames) poses.push_back(world_from_camera.at(frame.stamp_ns));

  ThreeViewMeasures measures;
  for (const LineTrack& track : collectTracks(frames)) {
    for (std::size_t i = 2; i < track.lines.size(); ++i) {
      const std::size_t k = track.first_frame + i;
      if (!poses[k - 2] || !poses[k - 1] || !poses[k]) continue;
      ++measures.triples;
      const auto error = threeViewError(camera, {*poses[k - 2], *poses[k - 1], *poses[k]},
                                        {track.lines[i - 2], track.lines[i - 1], track.lines[i]});
      if (!error || error->isIllPosed()) {
        ++measures.left_out;
      } else {
        measures.judged.push_back({k - 2, track.lines[i]->id, error->error_px});
      }
    }
  }
  const auto below = [&](double limit) {
    return static_cast<std::size_t>(
        std::count_if(measures.judged.begin(), measures.judged.end(),
                      [&](const ThreeViewMeasures::Triple& triple) { return triple.error < limit; }));
  };
  measures.refuted = measures.judged.size() - below(inlier_px);
  measures.inlier_ratio = shareOf(below(inlier_px), measures.judged.size());
  measures.tight_inlier_ratio = shareOf(below(tight_inlier_px), measures.judged.size());
  measures.left_out_ratio = shareOf(measures.left_out, measures.triples);
  measures.refuted_ratio = shareOf(measures.refuted, measures.triples);
  return measures;
}

TripleAgreement compareJudges(const ThreeViewMeasures& three_view, const std::vector<PairError>& pairs,
                              double inlier_px) {
  std::map<std::pair<std::size_t, std::uint64_t>, double> error_of;
  for (const PairError& pair : pairs) {
    if (!std::isnan(pair.error)) error_of[{pair.frame, pair.id}] = pair.error;
  }
  std::size_t count = 0;
  std::size_t right_by_views = 0;
  std::size_t right_by_truth = 0;
  for (const ThreeViewMeasures::Triple& triple : three_view.judged) {
    const auto first = error_of.find({triple.frame, triple.id});
    const auto second = error_of.find({triple.frame + 1, triple.id});
    if (first == error_of.end() || second == error_of.end()) continue;
    ++count;
    right_by_views += triple.error < inlier_px ? 1 : 0;
    right_by_truth += std::max(first->second, second->second) < inlier_px ? 1 : 0;
  }
  return {shareOf(right_by_views, count), shareOf(right_by_truth, count)};
}

}  // namespace tet_line_tracker
