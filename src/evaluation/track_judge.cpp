#include "track_judge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "undistorted_line.h"

namespace tet_line_tracker {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

LiftedSegment::LiftedSegment(const Truth& truth, std::int64_t stamp_ns, const TrackedLine& line)
    : truth_(truth) {
  const UndistortedLine undistorted(truth.camera(), line);
  for (std::size_t i = 0; i < kPoints; ++i) {
    // Each point stands for a ninth of the segment, itself in the middle: the very ends are often off the
    // edge.
    const double fraction = (static_cast<double>(i) + 0.5) / kPoints;
    const auto sample = undistorted.at(fraction);
    if (sample) points_[i] = truth.lift(stamp_ns, sample->pixel, sample->normal);
  }
}

std::optional<LiftedSegment::Error> LiftedSegment::errorOf(std::int64_t stamp_ns,
                                                           const TrackedLine& other) const {
  constexpr std::size_t kEnough = 3;
  const UndistortedLine undistorted(truth_.camera(), other);
  std::vector<double> inside;
  std::vector<double> anywhere;
  for (const auto& point : points_) {
    if (!point) continue;
    const auto view = truth_.view(*point, stamp_ns);
    if (!view || view->hidden) continue;
    const auto distance = undistorted.distance(view->pixel, view->in_camera);
    if (!distance) continue;
    anywhere.push_back(*distance);
    if (view->in_picture) inside.push_back(*distance);
  }
  std::vector<double>& distances = inside.size() >= kEnough ? inside : anywhere;
  if (distances.empty()) return std::nullopt;
  // The truth moves the line to where it lies from the tracked one; the error is the other way round.
  const double signed_px = -median(distances);
  for (double& distance : distances) distance = std::abs(distance);
  return Error{signed_px, median(distances)};
}

bool LiftedSegment::inView(std::int64_t stamp_ns, double min_length) const {
  std::size_t visible = 0;
  std::optional<std::pair<std::size_t, Eigen::Vector2d>> first;
  std::optional<std::pair<std::size_t, Eigen::Vector2d>> last;
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (2 * (visible + kPoints - i) < kPoints) return false;  // not even with all the others
    if (!points_[i]) continue;
    const auto view = truth_.view(*points_[i], stamp_ns);
    if (!view || view->hidden || !view->in_picture) continue;
    ++visible;
    if (!first) first.emplace(i, view->pixel);
    last.emplace(i, view->pixel);
  }
  if (2 * visible < kPoints || first->first == last->first) return false;
  // The outermost points stand for half a step beyond themselves.
  const double steps = static_cast<double>(last->first - first->first);
  const double length = (last->second - first->second).norm() * (steps + 1.0) / steps;
  return length >= min_length - 1e-3;
}

}  // namespace tet_line_tracker
