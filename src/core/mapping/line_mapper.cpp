#include "tet_line_tracker/mapping/line_mapper.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace tet_line_tracker {
namespace {

constexpr double kDegree = 0.017453292519943295;  // [rad]

struct WidestPair {
  std::size_t first{0}, second{0};
  double angle{0.0};  ///< [rad]
};

WidestPair widestPair(const std::vector<LineView>& views) {
  std::vector<Eigen::Vector3d> planes;
  planes.reserve(views.size());
  for (const LineView& view : views) planes.push_back(view.plane());
  WidestPair widest;
  double smallest_cosine = 1.0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const double cosine = std::abs(planes[i].dot(planes[j]));
      if (cosine >= smallest_cosine) continue;
      smallest_cosine = cosine;
      widest = {i, j, std::acos(cosine)};
    }
  }
  return widest;
}

/// Place along the line, from its foot, that is nearest to a ray; nothing when the ray runs along the line,
/// or meets it behind the camera or beyond `max_distance` [m].
std::optional<double> placeOf(const Eigen::Vector3d& ray, const PlueckerLine& line,
                              const Eigen::Vector3d& centre, double max_distance) {
  const double cosine = ray.dot(line.direction);
  const double sine_squared = 1.0 - cosine * cosine;
  constexpr double kSmallestSine = 0.05;  // 3 degrees: the place would be 20 times less sure than the ray
  if (sine_squared < kSmallestSine * kSmallestSine) return std::nullopt;
  const Eigen::Vector3d to_foot = line.foot() - centre;
  const double depth = (to_foot.dot(ray) - to_foot.dot(line.direction) * cosine) / sine_squared;
  if (!(depth > 0.0) || depth > max_distance) return std::nullopt;
  return depth * cosine - to_foot.dot(line.direction);
}

struct Ends {
  double start, end;  ///< places along the line, from its foot [m]
};

/// The larger part that the first and the last view see; nothing when neither sees both ends in front of it
/// or they disagree on the direction.
std::optional<Ends> endsOf(const PlueckerLine& line, const std::vector<LineView>& views,
                           double max_distance) {
  std::optional<Ends> ends;
  for (const LineView* view : {&views.front(), &views.back()}) {
    const auto start = placeOf(view->start_ray, line, view->centre, max_distance);
    const auto end = placeOf(view->end_ray, line, view->centre, max_distance);
    if (!start || !end) continue;
    if (!ends) {
      ends = {*start, *end};
    } else if ((ends->end > ends->start) != (*end > *start)) {
      return std::nullopt;
    } else if (*end > *start) {
      ends = {std::min(ends->start, *start), std::max(ends->end, *end)};
    } else {
      ends = {std::max(ends->start, *start), std::min(ends->end, *end)};
    }
  }
  return ends;
}

/// Standard deviation of the line across its direction at `point`, in the worst direction [m].
double sigmaAt(const Eigen::Vector3d& point, const LineEstimate& estimate) {
  const PlueckerLine& line = estimate.line;
  const Eigen::Matrix<double, 6, 4> derivatives = line.derivatives();
  // x cross direction = moment, moved: the part of dx across the line is direction x (dm - x cross dd).
  Eigen::Matrix<double, 3, 4> shift;
  for (int i = 0; i < 4; ++i) {
    shift.col(i) =
        line.direction.cross(derivatives.col(i).head<3>() - point.cross(derivatives.col(i).tail<3>()));
  }
  const Eigen::Matrix3d covariance = shift * estimate.covariance * shift.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues().maxCoeff()));
}

/// Covariance of the distances of start and end across the line [px^2], as far as the tracker knew it.
Eigen::Matrix2d covarianceOf(const TrackedLine& line, const LineMapperParameters& parameters) {
  const auto [start, both, end] = line.covariance_px;
  constexpr double kExact = 1e-6;  // [px^2]
  const float spread = start * end - both * both;
  Eigen::Matrix2d covariance;
  // Written so that NaN falls back.
  if (start > 0.0F && end > 0.0F && spread >= 0.0F && std::isfinite(start + end)) {
    covariance << start, both, both, end;
  } else if (std::isfinite(line.sigma_px)) {
    covariance = std::pow(static_cast<double>(line.sigma_px), 2) * Eigen::Matrix2d::Identity();
  } else {
    return std::pow(parameters.default_sigma, 2) * Eigen::Matrix2d::Identity();
  }
  covariance.diagonal().array() += std::pow(parameters.sigma_floor, 2) + kExact;
  return covariance;
}

std::optional<LineView> viewOf(const TrackedLine& line, const Eigen::Isometry3d& world_from_camera,
                               const LineMapperParameters& parameters) {
  if (!line.start_normalized.allFinite() || !line.end_normalized.allFinite()) return std::nullopt;
  const Eigen::Vector3d start = line.start_normalized.homogeneous().normalized();
  const Eigen::Vector3d end = line.end_normalized.homogeneous().normalized();
  const double angle = std::atan2(start.cross(end).norm(), start.dot(end));
  const double length = static_cast<double>(line.segment.length());
  if (!(angle > 1e-6) || !(length > 0.0)) return std::nullopt;
  LineView view;
  view.centre = world_from_camera.translation();
  view.start_ray = world_from_camera.linear() * start;
  view.end_ray = world_from_camera.linear() * end;
  view.px_angle = angle / length;
  const Eigen::Matrix2d deviations = covarianceOf(line, parameters).llt().matrixL();
  view.whitening = deviations.inverse() / view.px_angle;
  return view;
}

}  // namespace

ParameterTable tableOf(LineMapperParameters& p) {
  ParameterTable table;
  table.add("min_views", p.min_views, 2, 1000, "", "Images that must see a line");
  table.add("min_parallax", p.min_parallax, 0.01, 90.0, "deg",
            "Angle between the two viewing planes of a line that are furthest apart");
  table.add("max_reprojection", p.max_reprojection, 0.01, 100.0, "px",
            "Mean distance of the observed ends from the projected line");
  table.add("max_sigma", p.max_sigma, 1e-6, 100.0, "m",
            "Standard deviation of the ends across the line, in the worst direction");
  table.add("max_distance", p.max_distance, 0.1, 1e6, "m", "Distance of the ends from the camera");
  table.add("default_sigma", p.default_sigma, 0.01, 100.0, "px",
            "Standard deviation of an observed line whose tracker gave none");
  table.add("sigma_floor", p.sigma_floor, 0.0, 100.0, "px",
            "Added, in squares, to the standard deviation that the tracker gave");
  table.add(
      "correlated_views", p.correlated_views, 1.0, 1000.0, "",
      "Images in a row in which a tracker errs alike: so many count as one for the standard deviations");
  table.add("max_views", p.max_views, 4, 1000, "", "Images kept per line, spread over its life");
  table.add("max_lines", p.max_lines, 1, 1000000, "", "Finished lines in the map; the oldest are forgotten");
  return table;
}

LineMapper::LineMapper(const LineMapperParameters& parameters) : parameters_(parameters) {
  std::string broken;
  for (const std::string& sentence : tableOf(parameters_).check()) {
    broken += (broken.empty() ? "" : "; ") + sentence;
  }
  if (!broken.empty()) throw std::invalid_argument(broken);
}

void LineMapper::add(const LineFrame& frame, const Eigen::Isometry3d& world_from_camera) {
  std::unordered_map<std::uint64_t, Track> going_on;
  for (const TrackedLine& line : frame.lines) {
    const std::optional<LineView> view = viewOf(line, world_from_camera, parameters_);
    auto found = tracks_.find(line.id);
    // A track is one image older in each image; where that does not add up the id belongs to another tracker.
    const bool same = found != tracks_.end() && found->second.epoch == frame.epoch &&
                      frame.image_count >= found->second.image_count &&
                      line.age == found->second.age + (frame.image_count - found->second.image_count);
    Track track;
    if (same) {
      track = std::move(found->second);
      tracks_.erase(found);
    } else {
      if (!view) continue;
      track.id = next_id_++;
      track.epoch = frame.epoch;
      track.track = line.id;
    }
    track.age = line.age;
    track.image_count = frame.image_count;
    if (view) addView(track, *view);
    going_on.emplace(line.id, std::move(track));
  }
  finish();
  tracks_ = std::move(going_on);
}

void LineMapper::addView(Track& track, const LineView& view) const {
  track.changed = true;
  track.last.reset();
  if (track.views++ % track.stride != 0) {
    track.last = view;
    return;
  }
  track.kept.push_back(view);
  if (track.kept.size() < static_cast<std::size_t>(parameters_.max_views)) return;
  // Every second view goes, the first one stays.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < track.kept.size(); i += 2) track.kept[kept++] = track.kept[i];
  track.kept.resize(kept);
  track.stride *= 2;
}

void LineMapper::finish() {
  std::vector<Track*> ended;
  for (auto& [id, track] : tracks_) ended.push_back(&track);
  std::sort(ended.begin(), ended.end(), [](const Track* a, const Track* b) { return a->id < b->id; });
  for (Track* track : ended) finish(*track);
  tracks_.clear();
}

void LineMapper::finish(Track& track) {
  std::optional<MappedLine> line = estimate(track, &rejected_);
  if (!line) return;
  line->finished = true;
  finished_.push_back(*line);
  if (finished_.size() > static_cast<std::size_t>(parameters_.max_lines)) finished_.pop_front();
}

std::vector<MappedLine> LineMapper::lines() {
  std::vector<MappedLine> result(finished_.begin(), finished_.end());
  const std::size_t finished = result.size();
  for (auto& [id, track] : tracks_) {
    if (track.changed) track.line = estimate(track, nullptr);
    track.changed = false;
    if (track.line) result.push_back(*track.line);
  }
  std::sort(result.begin() + static_cast<std::ptrdiff_t>(finished), result.end(),
            [](const MappedLine& a, const MappedLine& b) { return a.id < b.id; });
  return result;
}

std::optional<MappedLine> LineMapper::estimate(const Track& track, Rejected* rejected) const {
  Rejected ignored;
  Rejected& counts = rejected != nullptr ? *rejected : ignored;
  std::vector<LineView> views = track.kept;
  if (track.last) views.push_back(*track.last);
  if (track.views < parameters_.min_views || views.size() < 2) {
    ++counts.few_views;
    return std::nullopt;
  }
  // Numbers stay near 1 with the origin at the first camera, wherever in the world that is.
  const Eigen::Vector3d origin = views.front().centre;
  for (LineView& view : views) view.centre -= origin;

  const WidestPair widest = widestPair(views);
  if (widest.angle < parameters_.min_parallax * kDegree) {
    ++counts.parallax;
    return std::nullopt;
  }
  const auto initial = intersect(views[widest.first], views[widest.second]);
  auto estimate = initial ? refine(*initial, views) : std::nullopt;
  if (!estimate) {
    ++counts.parallax;
    return std::nullopt;
  }
  estimate->covariance *=
      std::clamp(parameters_.correlated_views / track.stride, 1.0, static_cast<double>(views.size()));
  double error = 0.0;
  for (double view_error : estimate->error_px) error += view_error / static_cast<double>(views.size());
  if (!(error <= parameters_.max_reprojection)) {
    ++counts.reprojection;
    return std::nullopt;
  }
  const auto ends = endsOf(estimate->line, views, parameters_.max_distance);
  if (!ends) {
    ++counts.ends;
    return std::nullopt;
  }

  MappedLine line;
  line.id = track.id;
  line.epoch = track.epoch;
  line.track = track.track;
  line.start = estimate->line.foot() + ends->start * estimate->line.direction;
  line.end = estimate->line.foot() + ends->end * estimate->line.direction;
  line.sigma_start = sigmaAt(line.start, *estimate);
  line.sigma_end = sigmaAt(line.end, *estimate);
  if (!(std::max(line.sigma_start, line.sigma_end) <= parameters_.max_sigma)) {
    ++counts.sigma;
    return std::nullopt;
  }
  line.views = track.views;
  line.reprojection_px = error;
  line.parallax = widest.angle;
  const Eigen::Vector3d middle = 0.5 * (line.start + line.end);
  for (const LineView& view : views) {
    line.distance += (middle - view.centre).norm() / static_cast<double>(views.size());
  }
  line.start += origin;
  line.end += origin;
  return line;
}

}  // namespace tet_line_tracker
