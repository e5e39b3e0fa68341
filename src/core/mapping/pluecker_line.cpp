#include "tet_line_tracker/mapping/pluecker_line.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "geometry/so3.h"

namespace tet_line_tracker {
namespace {

/// The orthonormal representation of Bartoli and Sturm.
struct OrthonormalLine {
  Eigen::Matrix3d axes;  ///< of moment, direction and their normal
  double moment;         ///< lengths of both, of unit length together
  double direction;
};

OrthonormalLine toOrthonormal(const PlueckerLine& line) {
  OrthonormalLine result;
  const double distance = line.moment.norm();
  result.axes.col(0) = line.moment / distance;
  result.axes.col(1) = line.direction;
  result.axes.col(2) = result.axes.col(0).cross(result.axes.col(1));
  const double scale = std::hypot(distance, 1.0);
  result.moment = distance / scale;
  result.direction = 1.0 / scale;
  return result;
}

/// Residuals and derivatives of one view: the angles between its rays and the plane of the line, whitened.
struct ViewResidual {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 4> jacobian;
};

ViewResidual computeResidual(const PlueckerLine& line, const LineView& view) {
  const Eigen::Vector3d normal = line.planeThrough(view.centre);
  const double distance = normal.norm();
  const Eigen::Vector3d unit = normal / distance;
  // d normal = d moment - centre x d direction
  const Eigen::Matrix<double, 6, 4> derivatives = line.derivatives();
  Eigen::Matrix<double, 3, 4> normal_derivatives;
  for (int i = 0; i < 4; ++i) {
    normal_derivatives.col(i) =
        derivatives.col(i).head<3>() - view.centre.cross(derivatives.col(i).tail<3>());
  }
  ViewResidual residual;
  const Eigen::Vector3d* rays[2] = {&view.start_ray, &view.end_ray};
  for (int i = 0; i < 2; ++i) {
    const double along = rays[i]->dot(unit);
    residual.value(i) = along;
    residual.jacobian.row(i) = (*rays[i] - along * unit).transpose() * normal_derivatives / distance;
  }
  residual.value = (view.whitening * residual.value).eval();
  residual.jacobian = (view.whitening * residual.jacobian).eval();
  return residual;
}

/// Huber loss of the norm of a view's two residuals: cost and weight.
struct RobustCost {
  double cost;
  double weight;
};

RobustCost huber(const Eigen::Vector2d& residual) {
  constexpr double kThreshold = 2.0;  // standard deviations
  const double length = residual.norm();
  if (length <= kThreshold) return {0.5 * length * length, 1.0};
  return {kThreshold * (length - 0.5 * kThreshold), kThreshold / length};
}

double computeCost(const PlueckerLine& line, const std::vector<LineView>& views) {
  double cost = 0.0;
  for (const LineView& view : views) {
    const Eigen::Vector3d unit = line.planeThrough(view.centre).normalized();
    const Eigen::Vector2d angles(view.start_ray.dot(unit), view.end_ray.dot(unit));
    cost += huber(view.whitening * angles).cost;
  }
  return cost;
}

}  // namespace

PlueckerLine PlueckerLine::moved(const Eigen::Vector4d& step) const {
  const OrthonormalLine line = toOrthonormal(*this);
  const Eigen::Matrix3d axes = line.axes * so3Exp(step.head<3>()).toRotationMatrix();
  const double moment = line.moment * std::cos(step(3)) - line.direction * std::sin(step(3));
  const double direction = line.moment * std::sin(step(3)) + line.direction * std::cos(step(3));
  return {axes.col(1), axes.col(0) * (moment / direction)};
}

Eigen::Matrix<double, 6, 4> PlueckerLine::derivatives() const {
  const OrthonormalLine line = toOrthonormal(*this);
  const Eigen::Vector3d u1 = line.axes.col(0);
  const Eigen::Vector3d u2 = line.axes.col(1);
  const Eigen::Vector3d u3 = line.axes.col(2);
  // The scale of the orthonormal pair; brought back to a unit direction so that lengths are metres.
  const double scale = 1.0 / line.direction;
  Eigen::Matrix<double, 6, 4> d;
  d.col(0) << Eigen::Vector3d::Zero(), line.direction * u3;
  d.col(1) << -line.moment * u3, Eigen::Vector3d::Zero();
  d.col(2) << line.moment * u2, -line.direction * u1;
  d.col(3) << -line.direction * u1, line.moment * u2;
  return d * scale;
}

std::optional<PlueckerLine> intersect(const LineView& a, const LineView& b) {
  const Eigen::Vector3d normal_a = a.plane();
  const Eigen::Vector3d normal_b = b.plane();
  const Eigen::Vector3d direction = normal_a.cross(normal_b);
  const double sine = direction.norm();
  if (!(sine > 1e-6)) return std::nullopt;
  const Eigen::Vector3d moment =
      (normal_a * normal_b.dot(b.centre) - normal_b * normal_a.dot(a.centre)) / sine;
  return PlueckerLine{direction / sine, moment};
}

std::optional<LineEstimate> refine(const PlueckerLine& initial, const std::vector<LineView>& views) {
  LineEstimate estimate;
  estimate.line = initial;
  double cost = computeCost(initial, views);
  double damping = 1e-4;
  Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
  constexpr int kMaxIterations = 30;
  for (int i = 0; i < kMaxIterations && damping < 1e8; ++i) {
    if (!std::isfinite(cost) || !(estimate.line.moment.norm() > 1e-9)) return std::nullopt;
    hessian.setZero();
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    for (const LineView& view : views) {
      const ViewResidual residual = computeResidual(estimate.line, view);
      const double weight = huber(residual.value).weight;
      hessian += weight * residual.jacobian.transpose() * residual.jacobian;
      gradient += weight * residual.jacobian.transpose() * residual.value;
    }
    Eigen::Matrix4d damped = hessian;
    damped.diagonal() += damping * hessian.diagonal() + Eigen::Vector4d::Constant(1e-12);
    const Eigen::Vector4d step = -damped.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    const PlueckerLine next = estimate.line.moved(step);
    const double next_cost = computeCost(next, views);
    if (next_cost <= cost) {
      const bool converged = cost - next_cost < 1e-9 * (1.0 + cost) && step.norm() < 1e-7;
      estimate.line = next;
      cost = next_cost;
      damping = std::fmax(1e-9, 0.1 * damping);
      if (converged) break;
    } else {
      damping *= 10.0;
    }
  }
  estimate.covariance = hessian.inverse();
  if (!estimate.covariance.allFinite() || !(estimate.covariance.diagonal().minCoeff() > 0.0)) {
    return std::nullopt;
  }
  for (const LineView& view : views) {
    const Eigen::Vector3d unit = estimate.line.planeThrough(view.centre).normalized();
    estimate.error_px.push_back(
        0.5 * (std::abs(view.start_ray.dot(unit)) + std::abs(view.end_ray.dot(unit))) / view.px_angle);
  }
  return estimate;
}

}  // namespace tet_line_tracker
