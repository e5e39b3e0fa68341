#include "map_accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr int kPoints = 5;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

}  // namespace

std::optional<LineError> errorOf(const LineInSpace& line, const std::vector<TrueEdge>& edges,
                                 double max_direction, double max_across) {
  std::optional<LineError> best;
  const Eigen::Vector3d direction = (line.end - line.start).normalized();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const TrueEdge& edge = edges[i];
    const double length = (edge.end - edge.start).norm();
    if (!(length > 0.0)) continue;
    const Eigen::Vector3d along = (edge.end - edge.start) / length;
    const double angle = std::atan2(along.cross(direction).norm(), std::abs(along.dot(direction)));
    if (!(angle < max_direction)) continue;
    double across = 0.0;
    int beside = 0;
    for (int k = 0; k < kPoints; ++k) {
      const Eigen::Vector3d point = line.start + (line.end - line.start) * (k / (kPoints - 1.0));
      const Eigen::Vector3d from_start = point - edge.start;
      const double place = from_start.dot(along);
      across += (from_start - place * along).norm() / kPoints;
      if (place > -max_across && place < length + max_across) ++beside;
    }
    if (2 * beside < kPoints || !(across < max_across)) continue;
    if (!best || across < best->across_m) best = {i, angle, across};
  }
  return best;
}

MapAccuracy measureMap(const std::vector<LineInSpace>& lines, const std::vector<TrueEdge>& edges) {
  MapAccuracy accuracy;
  accuracy.lines = lines.size();
  std::set<std::size_t> seen;
  std::vector<double> directions;
  std::vector<double> distances;
  std::vector<double> claims;
  for (const LineInSpace& line : lines) {
    const auto error = errorOf(line, edges);
    if (error) {
      seen.insert(error->edge);
    } else {
      ++accuracy.without_edge;
    }
    directions.push_back(error ? error->direction_rad : std::numeric_limits<double>::infinity());
    distances.push_back(error ? error->across_m : std::numeric_limits<double>::infinity());
    claims.push_back(distances.back() / line.sigma);
  }
  accuracy.edges = seen.size();
  accuracy.direction_median = quantile(directions, 0.5);
  accuracy.direction_p90 = quantile(directions, 0.9);
  accuracy.across_median = quantile(distances, 0.5);
  accuracy.across_p90 = quantile(distances, 0.9);
  accuracy.claim_median = quantile(claims, 0.5);
  return accuracy;
}

}  // namespace tet_line_tracker
