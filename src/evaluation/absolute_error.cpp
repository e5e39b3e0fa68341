#include "absolute_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>

#include <opencv2/core/utility.hpp>

#include "undistorted_line.h"

namespace tet_line_tracker {
namespace {

constexpr std::size_t kPoints = 9;
constexpr std::size_t kBeside = 5;          // of kPoints: a line shows an edge that most of it lies on
constexpr std::size_t kCompeting = 2;       // of kPoints beside which another edge may be what the line shows
constexpr double kCompetingCosine = 0.966;  // 15 degrees: edges that cross the line at more are no rivals
constexpr double kBeyondEndPx = 3.0;        // a point this far beyond the end of an edge is still beside it
constexpr double kCollinear = 1e-4;         // [m]
constexpr double kTouching = 1e-3;          // [m]
constexpr double kFarOff = 0.1;  // sine of the angle beyond which the exact distance is not asked for
constexpr double kMedianOfNormal = 0.6744898;  // of |x|, x of deviation 1

std::size_t rootOf(std::vector<std::size_t>& parents, std::size_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

/// Numbers edges so that those on one infinite line, or also touching on it, have one number.
void group(const std::vector<TrueEdge>& edges, std::vector<std::size_t>& lines,
           std::vector<std::size_t>& chains) {
  lines.resize(edges.size());
  std::iota(lines.begin(), lines.end(), std::size_t{0});
  chains = lines;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector3d way = edges[i].end - edges[i].start;
    const double length = way.norm();
    if (!(length > 0.0)) continue;
    const Eigen::Vector3d along = way / length;
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      const Eigen::Vector3d start = edges[k].start - edges[i].start;
      if (along.cross(start).squaredNorm() > kCollinear * kCollinear) continue;
      const Eigen::Vector3d end = edges[k].end - edges[i].start;
      if (along.cross(end).squaredNorm() > kCollinear * kCollinear) continue;
      lines[rootOf(lines, k)] = rootOf(lines, i);
      const double low = std::min(along.dot(start), along.dot(end));
      const double high = std::max(along.dot(start), along.dot(end));
      if (low < length + kTouching && high > -kTouching) chains[rootOf(chains, k)] = rootOf(chains, i);
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    lines[i] = rootOf(lines, i);
    chains[i] = rootOf(chains, i);
  }
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return AbsoluteErrors::kUnknown;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Collects the lines of one class.
class Collector {
 public:
  void add(const TrackedLine& line, const EdgeVerdict& verdict) {
    ++errors_.lines;
    errors_.ambiguous += verdict.kind == EdgeVerdict::Kind::kAmbiguous ? 1 : 0;
    if (verdict.kind != EdgeVerdict::Kind::kJudged) return;
    ++errors_.judged;
    const double start = std::abs(verdict.start_px);
    const double end = std::abs(verdict.end_px);
    worse_.push_back(std::max(start, end));
    middle_.push_back(std::abs(verdict.middle_px));
    const double sigma = static_cast<double>(line.sigma_px);
    // Written so that NaN falls back.
    const auto deviation = [sigma](float variance) {
      return std::isfinite(variance) ? std::sqrt(static_cast<double>(variance)) : sigma;
    };
    const double start_sigma = deviation(line.covariance_px[0]);
    const double end_sigma = deviation(line.covariance_px[2]);
    if (start_sigma > 0.0 && end_sigma > 0.0) {
      ends_.push_back(start / start_sigma);
      ends_.push_back(end / end_sigma);
      worse_normalized_.push_back(std::max(start / start_sigma, end / end_sigma));
    }
    if (sigma > 0.0) middle_normalized_.push_back(middle_.back() / sigma);
  }

  AbsoluteErrors errors() const {
    AbsoluteErrors errors = errors_;
    errors.worse_median = quantile(worse_, 0.5);
    errors.worse_p90 = quantile(worse_, 0.9);
    errors.middle_median = quantile(middle_, 0.5);
    errors.middle_p90 = quantile(middle_, 0.9);
    errors.normalized = quantile(ends_, 0.5) / kMedianOfNormal;
    errors.normalized_middle = quantile(middle_normalized_, 0.5) / kMedianOfNormal;
    errors.normalized_worse = quantile(worse_normalized_, 0.5);
    const double squares = std::inner_product(ends_.begin(), ends_.end(), ends_.begin(), 0.0);
    if (!ends_.empty()) errors.normalized_rms = std::sqrt(squares / static_cast<double>(ends_.size()));
    return errors;
  }

 private:
  AbsoluteErrors errors_;
  std::vector<double> worse_, middle_, ends_, worse_normalized_, middle_normalized_;
};

}  // namespace

/// The edges as one image sees them.
struct EdgeJudge::View {
  std::int64_t stamp_ns{0};
  bool known{false};
  Eigen::Isometry3d world_from_camera;
  std::vector<Eigen::Vector3d> starts, ways;  ///< in the optical frame [m]
  std::vector<Eigen::Vector3d> planes;        ///< unit normals; zero where the camera looks along the edge
};

EdgeJudge::EdgeJudge(const SceneTruth& truth) : truth_(truth) {
  group(truth.edges(), line_of_, edge_of_);
  const CameraCalibration& calibration = truth.camera().calibration();
  on_unit_plane_ = calibration.model != "equidistant" && calibration.model != "mei";
  focal_px_ = std::sqrt(std::abs(calibration.fx * calibration.fy));
}

EdgeJudge::View EdgeJudge::viewAt(std::int64_t stamp_ns) const {
  View view;
  const auto pose = truth_.worldFromCamera(stamp_ns);
  if (!pose) return view;
  view.stamp_ns = stamp_ns;
  view.known = true;
  view.world_from_camera = *pose;
  const Eigen::Isometry3d camera_from_world = pose->inverse();
  for (const TrueEdge& edge : truth_.edges()) {
    view.starts.emplace_back(camera_from_world * edge.start);
    view.ways.emplace_back(camera_from_world.linear() * (edge.end - edge.start));
    const Eigen::Vector3d normal = view.starts.back().cross(view.ways.back());
    view.planes.emplace_back(normal.norm() > 1e-9 ? normal.normalized() : Eigen::Vector3d::Zero());
  }
  return view;
}

double EdgeJudge::distance(const Eigen::Vector3d& plane, const Eigen::Vector3d& ray) const {
  if (on_unit_plane_) return focal_px_ * plane.dot(ray) / (ray.z() * plane.head<2>().norm());
  return imageDistance(truth_.camera(), plane, ray).value_or(std::numeric_limits<double>::infinity());
}

bool EdgeJudge::isSeen(const View& view, std::size_t edge, const Eigen::Vector3d& ray) const {
  const Eigen::Vector3d& start = view.starts[edge];
  const Eigen::Vector3d& way = view.ways[edge];
  const Eigen::Vector3d across = view.planes[edge].cross(ray);
  const double place = -across.dot(start) / across.dot(way);
  if (!std::isfinite(place)) return false;
  const Eigen::Vector3d point = start + std::clamp(place, 0.0, 1.0) * way;
  if (!(point.dot(ray) > 0.0)) return false;
  if (place < 0.0 || place > 1.0) {
    const Eigen::Vector3d foot = ray - view.planes[edge].dot(ray) * view.planes[edge];
    if (!(foot.cross(point).norm() < kBeyondEndPx / focal_px_ * foot.norm() * point.norm())) return false;
  }
  return !truth_.isHidden(view.world_from_camera * point, view.stamp_ns);
}

EdgeVerdict EdgeJudge::judge(const TrackedLine& line, const View& view) const {
  const auto ray = [&](const Eigen::Vector2d& normalized, const Eigen::Vector2f& pixel) {
    if (!normalized.allFinite()) return truth_.camera().unproject(pixel.cast<double>());
    const Eigen::Vector3d on_plane = normalized.homogeneous();
    // Far out on z = 1 steps along the line are many times longer in the image than near the axis.
    return std::optional<Eigen::Vector3d>(on_unit_plane_ ? on_plane : on_plane.normalized());
  };
  EdgeVerdict verdict;
  const auto start = ray(line.start_normalized, line.segment.start);
  const auto end = ray(line.end_normalized, line.segment.end);
  if (!view.known || !start || !end) return verdict;
  std::array<Eigen::Vector3d, kPoints> rays;
  for (std::size_t i = 0; i < kPoints; ++i) {
    rays[i] = *start + (static_cast<double>(i) / (kPoints - 1.0)) * (*end - *start);
  }
  const Eigen::Vector3d& middle = rays[kPoints / 2];

  // The visible edges beside the line; those on one straight line in space count together.
  struct Candidate {
    std::size_t edge{0};
    double mean_px{0.0};
    std::size_t most_seen{0};
    std::array<bool, kPoints> seen{};
  };
  std::vector<Candidate> candidates;
  const auto isNear = [&](std::size_t edge, const Eigen::Vector3d& at) {
    return std::abs(view.planes[edge].dot(at)) < kFarOff * at.norm();
  };
  std::vector<std::size_t> around;
  for (std::size_t i = 0; i < view.planes.size(); ++i) {
    if (view.planes[i].isZero() || !isNear(i, *start) || !isNear(i, *end)) continue;
    around.push_back(i);
    const double start_px = std::abs(distance(view.planes[i], *start));
    const double end_px = std::abs(distance(view.planes[i], *end));
    if (!(start_px < kGatePx && end_px < kGatePx)) continue;
    auto place = std::find_if(candidates.begin(), candidates.end(),
                              [&](const Candidate& other) { return line_of_[other.edge] == line_of_[i]; });
    if (place == candidates.end()) {
      const double middle_px = std::abs(distance(view.planes[i], middle));
      candidates.push_back({i, (start_px + end_px + middle_px) / 3.0, 0, {}});
      place = candidates.end() - 1;
    }
    std::size_t seen = 0;
    for (std::size_t k = 0; k < kPoints; ++k) {
      if (!isSeen(view, i, rays[k])) continue;
      place->seen[k] = true;
      ++seen;
    }
    if (seen <= place->most_seen) continue;
    place->most_seen = seen;
    place->edge = i;
  }
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates) {
    const auto beside = std::count(candidate.seen.begin(), candidate.seen.end(), true);
    if (static_cast<std::size_t>(beside) < kBeside) continue;
    if (best == nullptr || candidate.mean_px < best->mean_px) best = &candidate;
  }
  if (best == nullptr) return verdict;

  const Eigen::Vector3d& plane = view.planes[best->edge];
  verdict.edge = edge_of_[best->edge];
  verdict.start_px = distance(plane, *start);
  verdict.end_px = distance(plane, *end);
  verdict.middle_px = distance(plane, middle);
  verdict.kind = EdgeVerdict::Kind::kJudged;
  // Rivals are near the edge, not near the line: how far the line is off must not decide whether it counts.
  const Eigen::Vector3d foot = (middle - plane.dot(middle) * plane).normalized();
  for (const std::size_t i : around) {
    if (line_of_[i] == line_of_[best->edge]) continue;
    const Eigen::Vector3d along = view.planes[i].cross(foot).normalized();
    if (!(std::abs(plane.cross(foot).dot(along)) > kCompetingCosine)) continue;
    std::size_t competing = 0;
    for (const Eigen::Vector3d& at : rays) {
      const Eigen::Vector3d on_edge = at - plane.dot(at) * plane;
      if (!(std::abs(distance(view.planes[i], on_edge)) < kSeparationPx)) continue;
      if (isSeen(view, i, on_edge) && ++competing >= kCompeting) break;
    }
    if (competing < kCompeting) continue;
    verdict.kind = EdgeVerdict::Kind::kAmbiguous;
    break;
  }
  return verdict;
}

std::vector<EdgeVerdict> EdgeJudge::judge(const LineFrame& frame) const {
  const View view = viewAt(frame.stamp_ns);
  std::vector<EdgeVerdict> verdicts;
  verdicts.reserve(frame.lines.size());
  for (const TrackedLine& line : frame.lines) verdicts.push_back(judge(line, view));
  return verdicts;
}

AbsoluteMeasures measureAbsolute(const std::vector<LineFrame>& frames, const SceneTruth& truth) {
  const EdgeJudge judge(truth);
  std::vector<std::vector<EdgeVerdict>> verdicts(frames.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(frames.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto index = static_cast<std::size_t>(i);
      verdicts[index] = judge.judge(frames[index]);
    }
  });

  std::array<Collector, AbsoluteMeasures::kLengths.size() - 1> classes;
  Collector all;
  std::size_t shown = 0;
  std::size_t edges = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    std::unordered_map<std::size_t, std::size_t> lines_of;
    for (std::size_t i = 0; i < frames[k].lines.size(); ++i) {
      const TrackedLine& line = frames[k].lines[i];
      const EdgeVerdict& verdict = verdicts[k][i];
      if (verdict.kind == EdgeVerdict::Kind::kJudged) ++lines_of[verdict.edge];
      all.add(line, verdict);
      const auto& lengths = AbsoluteMeasures::kLengths;
      const auto above =
          std::upper_bound(lengths.begin(), lengths.end(), static_cast<double>(line.segment.length()));
      if (above == lengths.begin() || above == lengths.end()) continue;
      classes[static_cast<std::size_t>(above - lengths.begin()) - 1].add(line, verdict);
    }
    edges += lines_of.size();
    for (const auto& [edge, lines] : lines_of) shown += lines;
  }
  AbsoluteMeasures measures;
  for (std::size_t c = 0; c < classes.size(); ++c) measures.classes[c] = classes[c].errors();
  measures.all = all.errors();
  if (edges > 0) measures.tracks_per_edge = static_cast<double>(shown) / static_cast<double>(edges);
  return measures;
}

}  // namespace tet_line_tracker
