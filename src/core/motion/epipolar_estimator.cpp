#include "motion/epipolar_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr std::size_t kMinPairs = 10;
constexpr double kMinParallax = 0.7;  ///< median below which a direction is noise [px]
constexpr int kHypotheses = 80;
constexpr double kRansacScale = 2.0;  ///< distances count up to this one; the rotation is not exact yet [px]
constexpr double kInlierDistance = 1.5;  ///< [px]
constexpr double kRobustScale = 0.7;     ///< of the weights in the fit [px]
constexpr int kIterations = 7;
constexpr double kLastStep = 1e-6;       ///< the iterations end with a smaller one [rad]
constexpr int kWideIterations = 3;       ///< of the weights
constexpr double kSureRotation = 0.005;  ///< with more, several directions may fit [rad]
constexpr double kMinSine = 0.05;  ///< towards the epipole the distance from the epipolar plane says little
constexpr double kMinInliers = 0.5;

/// The ray of the image before, turned by a small correction more than was predicted.
Eigen::Vector3d turned(const PointPair& pair, const Eigen::Vector3d& rotation) {
  return pair.before + rotation.cross(pair.before);
}

/// The square of what turns translation . (before x now) into the distance from the epipolar line [px]:
/// per_px over the sine between `before` and the translation. `along`: component of `before` along it.
double squaredScale(double before_square, double along, double per_px) {
  const double across_square = before_square - along * along;
  return per_px * per_px * before_square / std::max(kMinSine * kMinSine * before_square, across_square);
}

double squaredScale(const Eigen::Vector3d& before, const Eigen::Vector3d& translation, double per_px) {
  return squaredScale(before.squaredNorm(), before.dot(translation), per_px);
}

/// Weighted sums of the products of five derivatives and of the distance, the upper triangle by rows.
class NormalEquations {
 public:
  void add(double weight, double distance, const std::array<double, 5>& row) {
    double* sum = products_.data();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double weighted = weight * row[i];
      gradient_[i] += weighted * distance;
      for (std::size_t j = i; j < row.size(); ++j) *sum++ += weighted * row[j];
    }
  }
  Eigen::Matrix<double, 5, 5> hessian() const {
    Eigen::Matrix<double, 5, 5> full;
    const double* sum = products_.data();
    for (int i = 0; i < 5; ++i) {
      for (int j = i; j < 5; ++j) full(i, j) = full(j, i) = *sum++;
    }
    return full;
  }
  Eigen::Matrix<double, 5, 1> gradient() const {
    return Eigen::Map<const Eigen::Matrix<double, 5, 1>>(gradient_.data());
  }

 private:
  std::array<double, 15> products_{};
  std::array<double, 5> gradient_{};
};

}  // namespace

double EpipolarEstimator::costOf(const Eigen::Vector3d& translation) const {
  double sum = 0.0;
  for (const Constraint& constraint : constraints_) {
    const double off = translation.dot(constraint.cross);
    sum += std::min(kRansacScale * kRansacScale,
                    off * off * squaredScale(constraint.before, translation, constraint.per_px));
  }
  return sum;
}

/// Of points that would lie behind the camera; the direction or its opposite, whichever has fewer.
double EpipolarEstimator::behindCost(const std::vector<PointPair>& pairs, const Candidate& candidate) const {
  double ahead = 0.0;
  double behind = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d before = turned(pairs[i], candidate.rotation);
    const Eigen::Vector3d cross = before.cross(pairs[i].now);
    const Eigen::Vector3d across = pairs[i].now.cross(candidate.translation);
    const double norm = across.norm();
    const double off = candidate.translation.dot(cross);
    const double square_distance =
        off * off * squaredScale(before, candidate.translation, constraints_[i].per_px);
    if (!(norm > kMinSine * pairs[i].now.norm()) || square_distance > kInlierDistance * kInlierDistance)
      continue;
    const double movement = constraints_[i].per_px * across.dot(cross) / norm / kRobustScale;
    const double square = movement * movement;
    (movement < 0.0 ? behind : ahead) += square / (1.0 + square);
  }
  return std::min(ahead, behind);
}

/// Gauss-Newton for the correction of the rotation and for the direction in its tangent plane.
EpipolarEstimator::Candidate EpipolarEstimator::fit(const std::vector<PointPair>& pairs, const Prior& known,
                                                    const Eigen::Vector3d& rotation,
                                                    const Eigen::Vector3d& translation) const {
  Candidate candidate{rotation, translation, std::numeric_limits<double>::infinity()};
  const double prior = 1.0 / (known.rotation_sigma * known.rotation_sigma);
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::Vector3d& best = candidate.translation;
    const Eigen::Vector3d u = best.unitOrthogonal();
    const Eigen::Vector3d v = best.cross(u);
    // Wide at first, so that it does not end where it begins.
    const double width = kRobustScale * std::max(1, 1 + kWideIterations - iteration);
    const double inverse_square = 1.0 / (width * width);
    NormalEquations equations;
    const Eigen::Vector3d from_prior = candidate.rotation - known.rotation;
    double cost = prior * from_prior.squaredNorm();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector3d& now = pairs[i].now;
      const Eigen::Vector3d before = turned(pairs[i], candidate.rotation);
      const Eigen::Vector3d cross = before.cross(now);
      const double along = before.dot(best);
      const double off = best.dot(cross);
      const double scale = inverse_square * squaredScale(before.squaredNorm(), along, constraints_[i].per_px);
      const double shrink = 1.0 / (1.0 + off * off * scale);
      cost += off * off * scale * shrink;
      // before x (now x best), by the rule for double products.
      const Eigen::Vector3d by_rotation = along * now - before.dot(now) * best;
      equations.add(scale * shrink * shrink, off,
                    {by_rotation.x(), by_rotation.y(), by_rotation.z(), u.dot(cross), v.dot(cross)});
    }
    if (iteration == kIterations) {
      candidate.cost = cost + behindCost(pairs, candidate);
      break;
    }
    Eigen::Matrix<double, 5, 5> hessian = equations.hessian();
    Eigen::Matrix<double, 5, 1> gradient = equations.gradient();
    hessian.topLeftCorner<3, 3>().diagonal().array() += prior;
    hessian.diagonal().array() += 1e-6;
    gradient.head<3>() += prior * from_prior;
    const Eigen::Matrix<double, 5, 1> step = -hessian.ldlt().solve(gradient);
    if (!step.allFinite()) {
      candidate.cost = std::numeric_limits<double>::infinity();
      break;
    }
    candidate.rotation += step.head<3>();
    if (iteration >= kWideIterations && step.squaredNorm() < kLastStep * kLastStep)
      iteration = kIterations - 1;
    best = (best + std::clamp(step[3], -0.5, 0.5) * u + std::clamp(step[4], -0.5, 0.5) * v).normalized();
  }
  return candidate;
}

double EpipolarEstimator::parallaxOf(const std::vector<PointPair>& pairs, double focal,
                                     const Eigen::Vector3d& rotation) {
  parallax_.clear();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d before = turned(pair, rotation);
    parallax_.push_back(focal * before.cross(pair.now).norm() / (before.norm() * pair.now.norm()));
  }
  const auto middle = parallax_.begin() + static_cast<std::ptrdiff_t>(parallax_.size() / 2);
  std::nth_element(parallax_.begin(), middle, parallax_.end());
  return *middle;
}

EgoMotion EpipolarEstimator::estimate(std::vector<PointPair>& pairs, double focal, const Prior& prior) {
  EgoMotion motion;
  for (PointPair& pair : pairs) pair.inlier = false;
  if (pairs.size() < kMinPairs) return motion;
  constraints_.clear();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d before = turned(pair, prior.rotation);
    constraints_.push_back({before.cross(pair.now), focal / (before.norm() * pair.now.norm()), before});
  }
  if (parallaxOf(pairs, focal, prior.rotation) < kMinParallax) {
    motion.rotates = true;
    motion.rotation = prior.rotation;
    const auto isExplained = [](double px) { return px < kInlierDistance; };
    motion.agreeing =
        static_cast<std::size_t>(std::count_if(parallax_.begin(), parallax_.end(), isExplained));
    return motion;
  }

  Eigen::Vector3d sampled = Eigen::Vector3d::Zero();
  double sampled_cost = std::numeric_limits<double>::infinity();
  std::uint32_t state = 12345;
  const auto draw = [&state](std::size_t count) {
    state = state * 1664525U + 1013904223U;
    return static_cast<std::size_t>((static_cast<std::uint64_t>(state) * count) >> 32U);
  };
  for (int i = 0; i < kHypotheses; ++i) {
    const std::size_t a = draw(pairs.size());
    const std::size_t b = draw(pairs.size());
    const Eigen::Vector3d direction = constraints_[a].cross.cross(constraints_[b].cross);
    const double norm = direction.norm();
    if (!(norm > 1e-12)) continue;
    const double cost = costOf(direction / norm);
    if (cost < sampled_cost) {
      sampled_cost = cost;
      sampled = direction / norm;
    }
  }
  Candidate found{prior.rotation, Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
  const auto tryFrom = [&](const Eigen::Vector3d& rotation, const Eigen::Vector3d& direction) {
    if (direction.isZero()) return;
    const Candidate candidate = fit(pairs, prior, rotation, direction);
    if (candidate.cost < found.cost) found = candidate;
  };
  tryFrom(prior.rotation, sampled);
  tryFrom(prior.rotation, prior.translation);
  if (prior.rotation_sigma > kSureRotation) {
    tryFrom(prior.steady, prior.translation);
    for (int axis = 0; axis < 3; ++axis) tryFrom(prior.rotation, Eigen::Vector3d::Unit(axis));
  }
  if (found.translation.isZero()) return motion;
  const Eigen::Vector3d rotation = found.rotation;
  Eigen::Vector3d best = found.translation;

  // Points lie before the camera: that tells the direction from its opposite.
  double sign = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    PointPair& pair = pairs[i];
    const Eigen::Vector3d before = turned(pair, rotation);
    const Eigen::Vector3d cross = before.cross(pair.now);
    const double off = best.dot(cross);
    pair.inlier =
        off * off * squaredScale(before, best, constraints_[i].per_px) < kInlierDistance * kInlierDistance;
    const Eigen::Vector3d across = pair.now.cross(best);
    const double square = across.squaredNorm();
    pair.inverse_depth = square > 1e-9 ? across.dot(cross) / square : 0.0;
    if (pair.inlier) {
      const double px = std::sqrt(square) * focal * pair.inverse_depth / pair.now.squaredNorm();
      sign += std::clamp(px, -3.0, 3.0);
    }
  }
  if (sign < 0.0) best = -best;
  for (PointPair& pair : pairs) {
    if (sign < 0.0) pair.inverse_depth = -pair.inverse_depth;
    const double px = pair.now.cross(best).norm() * focal * pair.inverse_depth / pair.now.squaredNorm();
    if (px < -kInlierDistance) pair.inlier = false;
    if (pair.inlier) ++motion.inliers;
  }
  motion.agreeing = motion.inliers;
  if (static_cast<double>(motion.inliers) < kMinInliers * static_cast<double>(pairs.size())) return motion;
  motion.rotates = true;
  motion.rotation = rotation;
  // A rotation that explains all of it leaves the direction to chance.
  if (parallaxOf(pairs, focal, rotation) < kMinParallax) return motion;
  motion.translation = best;
  return motion;
}

}  // namespace tet_line_tracker
