#include "homography_consensus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include <Eigen/Dense>

namespace tet_line_tracker {
namespace {

using Points = std::array<Eigen::Vector3d, 2>;

struct Match {
  Points before, after;                     ///< endpoints, scaled to about -1..1, homogeneous
  Eigen::Vector3d line_before, line_after;  ///< unit normal and distance
};

Eigen::Vector3d lineThrough(const Points& points) {
  const Eigen::Vector3d line = points[0].cross(points[1]);
  return line / line.head<2>().norm();
}

/// H with x' ~ H x from lines l and l' = H^-T l, that is l ~ H^T l': each pair gives l x (H^T l') = 0.
std::optional<Eigen::Matrix3d> fitHomography(const std::vector<Match>& matches,
                                             const std::vector<std::size_t>& chosen) {
  Eigen::Matrix<double, 9, 9> normal_matrix = Eigen::Matrix<double, 9, 9>::Zero();
  for (const std::size_t index : chosen) {
    const Match& match = matches[index];
    // Endpoints of the line before lie on H^T l': linear in H, and weighted by pixels rather than by the
    // scale of the line.
    for (const Eigen::Vector3d& point : match.before) {
      Eigen::Matrix<double, 9, 1> row;
      for (int r = 0; r < 3; ++r) row.segment<3>(3 * r) = match.line_after(r) * point;
      normal_matrix += row * row.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal_matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  // A second vanishing eigenvalue: the lines do not fix the homography.
  if (solver.eigenvalues()(1) < 1e-12 * solver.eigenvalues()(8)) return std::nullopt;
  Eigen::Matrix3d homography;
  for (int r = 0; r < 3; ++r) homography.row(r) = solver.eigenvectors().col(0).segment<3>(3 * r).transpose();
  if (std::abs(homography.determinant()) < 1e-9) return std::nullopt;
  return homography;
}

double errorAfterMoving(const Eigen::Matrix3d& homography, const Points& points,
                        const Eigen::Vector3d& line) {
  double worst = 0.0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d moved = homography * point;
    worst = std::max(worst, std::abs(line.dot(moved) / moved.z()));
  }
  return worst;
}

std::vector<std::size_t> agreeing(const Eigen::Matrix3d& homography, const std::vector<Match>& matches,
                                  double max_error) {
  const Eigen::Matrix3d inverse = homography.inverse();
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (errorAfterMoving(homography, match.before, match.line_after) < max_error &&
        errorAfterMoving(inverse, match.after, match.line_before) < max_error) {
      inliers.push_back(i);
    }
  }
  return inliers;
}

}  // namespace

std::vector<bool> homographyInliers(const std::vector<LineMatch>& matches, double max_error, int hypotheses) {
  constexpr std::size_t kLines = 4;
  if (matches.size() <= kLines) return {};

  // Centre and scale of all endpoints, so that the linear system is well conditioned.
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (const LineMatch& match : matches) {
    for (const Eigen::Vector2f& point :
         {match.before.start, match.before.end, match.after.start, match.after.end}) {
      low = low.cwiseMin(point.cast<double>());
      high = high.cwiseMax(point.cast<double>());
    }
  }
  const Eigen::Vector2d centre = 0.5 * (low + high);
  const double scale = 2.0 / std::max(1.0, (high - low).maxCoeff());
  const auto scaled = [&](const LineSegment& segment) -> Points {
    const auto point = [&](const Eigen::Vector2f& p) -> Eigen::Vector3d {
      return (scale * (p.cast<double>() - centre)).homogeneous();
    };
    return {point(segment.start), point(segment.end)};
  };
  std::vector<Match> prepared;
  prepared.reserve(matches.size());
  for (const LineMatch& match : matches) {
    Match entry{scaled(match.before), scaled(match.after), {}, {}};
    entry.line_before = lineThrough(entry.before);
    entry.line_after = lineThrough(entry.after);
    prepared.push_back(entry);
  }

  std::mt19937 random(1);  // fixed: the same matches give the same result
  std::vector<std::size_t> best;
  const auto consider = [&](const std::vector<std::size_t>& chosen) {
    const auto homography = fitHomography(prepared, chosen);
    if (!homography) return false;
    std::vector<std::size_t> inliers = agreeing(*homography, prepared, max_error * scale);
    if (inliers.size() <= best.size()) return false;
    best = std::move(inliers);
    return true;
  };
  // Enough when a sample without an outlier has been missed with a chance of 0.1 % only.
  const auto enough = [&](int tried) {
    const double share = static_cast<double>(best.size()) / static_cast<double>(matches.size());
    return std::pow(1.0 - std::pow(share, 4), tried) < 1e-3;
  };
  for (int i = 0; i < hypotheses && !enough(i); ++i) {
    std::vector<std::size_t> chosen;
    while (chosen.size() < kLines) {
      const std::size_t index = random() % prepared.size();
      if (std::find(chosen.begin(), chosen.end(), index) == chosen.end()) chosen.push_back(index);
    }
    if (!consider(chosen)) continue;
    // A fit to all that agree often gathers more.
    while (best.size() > kLines && consider(std::vector<std::size_t>(best))) {
    }
  }
  std::vector<bool> inlier(matches.size(), false);
  for (const std::size_t index : best) inlier[index] = true;
  return inlier;
}

}  // namespace tet_line_tracker
