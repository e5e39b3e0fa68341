#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "../simulation/scene_geometry.h"

namespace tet_line_tracker {

/// A line of a map.
struct LineInSpace {
  Eigen::Vector3d start;  ///< [m]
  Eigen::Vector3d end;    ///< [m]
  double distance;        ///< from the cameras that saw it [m]
  double sigma;           ///< that the map claims for its place across [m]
};

/// How far a line of a map is from the true edge that it shows.
struct LineError {
  std::size_t edge;      ///< index into SceneGeometry::edges()
  double direction_rad;  ///< angle between line and edge
  double across_m;       ///< mean distance of five points of the line from the edge's infinite line
};

/// The edge that runs along the line: less than `max_direction` [rad] and `max_across` [m] away, and at least
/// half of the line beside it. Of several the nearest; nothing when there is none.
std::optional<LineError> errorOf(const LineInSpace& line, const std::vector<TrueEdge>& edges,
                                 double max_direction = 0.17, double max_across = 0.1);

/// Errors of a map. A line without an edge counts as infinitely wrong in every quantile.
struct MapAccuracy {
  std::size_t lines{0};
  std::size_t without_edge{0};
  std::size_t edges{0};                          ///< different true edges that lines show
  double direction_median{0}, direction_p90{0};  ///< [rad]
  double across_median{0}, across_p90{0};        ///< [m]
  /// Median distance over claimed sigma: about 1.2 when the claims are true (two Gaussians across the line).
  double claim_median{0};
};

MapAccuracy measureMap(const std::vector<LineInSpace>& lines, const std::vector<TrueEdge>& edges);

}  // namespace tet_line_tracker
