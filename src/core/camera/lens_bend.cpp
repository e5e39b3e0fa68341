#include "tet_line_tracker/camera/lens_bend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace tet_line_tracker {
namespace {

/// Where along a line the lens is asked: Chebyshev's nodes, at which a polynomial fits best.
constexpr std::array<double, 3> kFewShares{0.0670, 0.5, 0.9330};
constexpr std::array<double, 5> kSomeShares{0.0245, 0.2061, 0.5000, 0.7939, 0.9755};
constexpr std::array<double, 7> kManyShares{0.0125, 0.1091, 0.2831, 0.5000, 0.7169, 0.8909, 0.9875};
constexpr std::array<double, LineBend::kTerms> kMostShares{0.0051, 0.0452, 0.1221, 0.2297, 0.3591, 0.5000,
                                                           0.6409, 0.7703, 0.8779, 0.9548, 0.9949};
constexpr float kShort = 60.0F;      ///< up to here few are enough [px]
constexpr float kMiddling = 130.0F;  ///< up to here some are [px]
constexpr float kLong = 250.0F;      ///< up to here many are [px]
constexpr double kMaxSum = 1e5;  ///< of the terms of a bend: no point of it is farther from the chord [px]

template <std::size_t kPoints>
LineBend bendThrough(const CameraModel& camera, const std::array<double, kPoints>& shares,
                     const LineSegment& segment, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector2d start = segment.start.cast<double>();
  const Eigen::Vector2d chord = segment.end.cast<double>() - start;
  const Eigen::Vector2d along = chord / chord.squaredNorm();
  const Eigen::Vector2d normal = Eigen::Vector2d(chord.y(), -chord.x()).normalized();
  std::array<double, kPoints> u, q;  // the factor of the bend at some places
  double sagitta = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const std::optional<Eigen::Vector2d> pixel = camera.project((1.0 - shares[i]) * from + shares[i] * to);
    if (!pixel) return {};
    const double fraction = along.dot(*pixel - start);
    const double offset = normal.dot(*pixel - start);
    // Written so that NaN fails.
    if (!(fraction > 0.001 && fraction < 0.999)) return {};
    u[i] = 2.0 * fraction - 1.0;
    q[i] = offset / (fraction * (1.0 - fraction));
    sagitta = std::max(sagitta, std::abs(offset));
  }
  if (!(sagitta >= LensBend::kMinSagitta)) return {};
  // The polynomial through all, by Newton's divided differences, then in powers of u.
  for (std::size_t order = 1; order < kPoints; ++order) {
    for (std::size_t i = kPoints - 1; i >= order; --i) q[i] = (q[i] - q[i - 1]) / (u[i] - u[i - order]);
  }
  std::array<double, kPoints> c{};
  for (std::size_t i = kPoints; i-- > 0;) {
    for (std::size_t k = kPoints - 1; k > 0; --k) c[k] = c[k - 1] - u[i] * c[k];
    c[0] = q[i] - u[i] * c[0];
  }
  // Pixels of a lens that is not smooth may fall on each other; written so that NaN fails.
  double sum = 0.0;
  for (const double term : c) sum += std::abs(term);
  if (!(sum < kMaxSum)) return {};
  LineBend bend;
  std::copy(c.begin(), c.end(), bend.c.begin());
  bend.terms = kPoints;
  return bend;
}

/// Lines along the borders and diagonals of an image bend more than any others.
std::array<LineSegment, 6> longestLines(int width, int height) {
  const Eigen::Vector2f a(0.0F, 0.0F);
  const Eigen::Vector2f b(static_cast<float>(width - 1), 0.0F);
  const Eigen::Vector2f c(static_cast<float>(width - 1), static_cast<float>(height - 1));
  const Eigen::Vector2f d(0.0F, static_cast<float>(height - 1));
  return {LineSegment{a, b}, {b, c}, {c, d}, {d, a}, {a, c}, {b, d}};
}

}  // namespace

LensBend::LensBend(std::shared_ptr<const CameraModel> camera, int width, int height)
    : camera_(std::move(camera)) {
  if (!camera_) return;
  if (!camera_->bendsLines()) {
    camera_.reset();
    return;
  }
  const Eigen::Vector2f centre(0.5F * static_cast<float>(width - 1), 0.5F * static_cast<float>(height - 1));
  for (const LineSegment& line : longestLines(width, height)) {
    // Wide lenses see no ray at their corners: nearer lines tell as well.
    for (const float share : {1.0F, 0.8F, 0.5F}) {
      const LineSegment nearer{centre + share * (line.start - centre), centre + share * (line.end - centre)};
      if (!between(nearer).isStraight()) return;
    }
  }
  camera_.reset();
}

LineBend LensBend::between(const LineSegment& segment) const {
  if (!camera_) return {};
  const std::optional<Eigen::Vector3d> start = camera_->unproject(segment.start.cast<double>());
  const std::optional<Eigen::Vector3d> end = camera_->unproject(segment.end.cast<double>());
  return start && end ? between(segment, *start, *end) : LineBend{};
}

LineBend LensBend::between(const LineSegment& segment, const Eigen::Vector3d& start,
                           const Eigen::Vector3d& end) const {
  const float length = segment.length();
  if (!camera_ || !(length > 1.0F)) return {};
  const Eigen::Vector3d from = start.normalized();
  const Eigen::Vector3d to = end.normalized();
  if (length < kShort) return bendThrough(*camera_, kFewShares, segment, from, to);
  if (length < kMiddling) return bendThrough(*camera_, kSomeShares, segment, from, to);
  if (length < kLong) return bendThrough(*camera_, kManyShares, segment, from, to);
  return bendThrough(*camera_, kMostShares, segment, from, to);
}

Eigen::Vector2f LensBend::beyond(const LineSegment& segment, float distance) const {
  const float share = distance / segment.length();
  Eigen::Vector2f straight = segment.at(1.0F + share);
  if (!camera_) return straight;
  const std::optional<Eigen::Vector3d> start = camera_->unproject(segment.start.cast<double>());
  const std::optional<Eigen::Vector3d> end = camera_->unproject(segment.end.cast<double>());
  if (!start || !end) return straight;
  const std::optional<Eigen::Vector2d> pixel =
      camera_->project(*end + static_cast<double>(share) * (*end - *start));
  return pixel ? Eigen::Vector2f(pixel->cast<float>()) : straight;
}

}  // namespace tet_line_tracker
