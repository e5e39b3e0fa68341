#include "tracking/edge_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tet_line_tracker {
namespace {

/// A distance between fit and prediction whose square is more than so many variances is movement that the
/// flow has not seen.
constexpr double kSurprise = 8.0;

/// Covariance of the distances of both ends. Scalars, so that all processors get the same bits.
struct Covariance {
  double start, both, end;

  explicit Covariance(const std::array<float, 3>& c)
      : start(static_cast<double>(c[0])), both(static_cast<double>(c[1])), end(static_cast<double>(c[2])) {}
  double middle() const { return 0.25 * (start + 2.0 * both + end); }
};

}  // namespace

EdgeFit updateEdge(const EdgePrediction& predicted, const EdgeFit& measured) {
  Covariance p(predicted.noise_px);
  const Covariance r(measured.noise_px);
  // Written so that NaN fails.
  if (!(p.start >= 0.0 && p.end >= 0.0 && r.start >= 0.0 && r.end >= 0.0)) return measured;
  const Eigen::Vector2f normal = predicted.segment.normal();
  const auto start = static_cast<double>(normal.dot(measured.segment.start - predicted.segment.start));
  const auto end = static_cast<double>(normal.dot(measured.segment.end - predicted.segment.end));
  const double flow =
      static_cast<double>(predicted.flow_sigma_px) * static_cast<double>(predicted.flow_sigma_px);
  p.start += flow;
  p.end += flow;
  p.start += std::max(0.0, start * start - kSurprise * (p.start + r.start));
  p.end += std::max(0.0, end * end - kSurprise * (p.end + r.end));

  const double a = p.start + r.start;
  const double b = p.both + r.both;
  const double c = p.end + r.end;
  const double determinant = a * c - b * b;
  if (!(determinant > 0.0)) return measured;
  // The gain: p times the inverse of p + r.
  const double start_start = (p.start * c - p.both * b) / determinant;
  const double start_end = (p.both * a - p.start * b) / determinant;
  const double end_start = (p.both * c - p.end * b) / determinant;
  const double end_end = (p.end * a - p.both * b) / determinant;

  EdgeFit updated = measured;
  updated.segment.start =
      predicted.segment.start + static_cast<float>(start_start * start + start_end * end) * normal;
  updated.segment.end =
      predicted.segment.end + static_cast<float>(end_start * start + end_end * end) * normal;
  updated.noise_px = {static_cast<float>(p.start - start_start * p.start - start_end * p.both),
                      static_cast<float>(p.both - start_start * p.both - start_end * p.end),
                      static_cast<float>(p.end - end_start * p.both - end_end * p.end)};
  for (std::size_t i = 0; i < updated.noise_px.size(); ++i) {
    updated.covariance_px[i] += updated.noise_px[i] - measured.noise_px[i];
  }
  const double share =
      Covariance(updated.covariance_px).middle() / Covariance(measured.covariance_px).middle();
  updated.sigma_px *= static_cast<float>(std::sqrt(share));
  return updated;
}

}  // namespace tet_line_tracker
