#include "line_array_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Cholesky>

namespace tet_line_tracker {
namespace {

bool hasPlace(const Line& line) {
  return std::isfinite(line.start_normalized[0]) && std::isfinite(line.start_normalized[1]) &&
         std::isfinite(line.end_normalized[0]) && std::isfinite(line.end_normalized[1]);
}

template <typename Normalized>
Eigen::Vector3f inFixedFrame(const Eigen::Isometry3d& pose, const Normalized& point, double depth) {
  return (pose * (depth * Eigen::Vector3d(point[0], point[1], 1.0))).template cast<float>();
}

Colour colourOf(const Line& line, const LineArrayStyle& style) {
  switch (style.colouring) {
    case LineArrayStyle::Colouring::kId:
      return colourOfId(line.id);
    case LineArrayStyle::Colouring::kAge:
      return colourOfTrackAge(line.age);
    case LineArrayStyle::Colouring::kLength: {
      const double length = std::hypot(line.end_px[0] - line.start_px[0], line.end_px[1] - line.start_px[1]);
      // Long lines are the good ones.
      return colourOnScale(1.0 - placeBetween(0.0, style.longest, length));
    }
    case LineArrayStyle::Colouring::kSigma:
      return colourOnScale(placeBetween(0.0, style.largest_sigma, line.sigma_px));
  }
  return kUnknownColour;
}

/// A line of the newest image, as far back as it has been followed.
struct TrailEnd {
  Eigen::Vector3f start;
  Eigen::Vector3f end;
  Colour colour;
};

/// Offset and slope of the straight line through values at places that fits best.
struct LinearFit {
  std::size_t count{0};
  Eigen::Matrix2d normal{Eigen::Matrix2d::Zero()};
  Eigen::Vector2d right{Eigen::Vector2d::Zero()};

  void add(double place, double value) {
    const Eigen::Vector2d row(1.0, place);
    normal += row * row.transpose();
    right += value * row;
    ++count;
  }
  double valueAt(double place) const { return normal.ldlt().solve(right).dot(Eigen::Vector2d(1.0, place)); }
};

void addFrustum(const PosedLines& image, const LineArrayStyle& style, std::vector<ShownLine>& lines) {
  LinearFit x;
  LinearFit y;
  for (const Line& line : image.message->lines) {
    if (!hasPlace(line)) continue;
    x.add(line.start_px[0], line.start_normalized[0]);
    x.add(line.end_px[0], line.end_normalized[0]);
    y.add(line.start_px[1], line.start_normalized[1]);
    y.add(line.end_px[1], line.end_normalized[1]);
  }
  constexpr std::size_t kMinEnds = 6;
  if (x.count < kMinEnds) return;
  const double left = x.valueAt(-0.5);
  const double right = x.valueAt(image.message->width - 0.5);
  const double top = y.valueAt(-0.5);
  const double bottom = y.valueAt(image.message->height - 0.5);
  const std::array<Eigen::Vector2d, 4> corners{{{left, top}, {right, top}, {right, bottom}, {left, bottom}}};
  const Eigen::Vector3f centre = image.pose.translation().cast<float>();
  Colour colour = kUnknownColour;
  colour.alpha = style.alpha;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3f corner = inFixedFrame(image.pose, corners[i], style.depth);
    const Eigen::Vector3f next = inFixedFrame(image.pose, corners[(i + 1) % corners.size()], style.depth);
    if (!corner.allFinite() || !next.allFinite()) return;
    lines.push_back({corner, next, colour, {}});
    lines.push_back({centre, corner, colour, {}});
  }
}

}  // namespace

ShownLines showLines(const std::deque<PosedLines>& images, const LineArrayStyle& style) {
  ShownLines shown;
  if (images.empty()) return shown;

  std::unordered_map<std::uint64_t, TrailEnd> trails;
  const PosedLines& newest = images.back();
  for (const Line& line : newest.message->lines) {
    if (!hasPlace(line)) {
      ++shown.without_place;
      continue;
    }
    if (line.age < style.min_age) {
      ++shown.hidden;
      continue;
    }
    ++shown.shown;
    Colour colour = colourOf(line, style);
    colour.alpha = style.alpha;
    const Eigen::Vector3f start = inFixedFrame(newest.pose, line.start_normalized, style.depth);
    const Eigen::Vector3f end = inFixedFrame(newest.pose, line.end_normalized, style.depth);
    shown.lines.push_back({start, end, colour, style.ids ? std::to_string(line.id) : std::string()});
    trails[line.id] = {start, end, colour};
  }

  const std::size_t earlier = std::min(style.trail, images.size() - 1);
  for (std::size_t back = 1; back <= earlier; ++back) {
    const PosedLines& image = images[images.size() - 1 - back];
    const auto opacity =
        static_cast<float>(1.0 - static_cast<double>(back) / static_cast<double>(style.trail + 1));
    for (const Line& line : image.message->lines) {
      const auto trail = trails.find(line.id);
      if (trail == trails.end() || !hasPlace(line)) continue;
      Colour colour = trail->second.colour;
      colour.alpha *= opacity;
      const Eigen::Vector3f start = inFixedFrame(image.pose, line.start_normalized, style.depth);
      const Eigen::Vector3f end = inFixedFrame(image.pose, line.end_normalized, style.depth);
      shown.lines.push_back({start, trail->second.start, colour, {}});
      shown.lines.push_back({end, trail->second.end, colour, {}});
      trail->second.start = start;
      trail->second.end = end;
    }
  }
  if (style.frustum) addFrustum(newest, style, shown.lines);
  return shown;
}

}  // namespace tet_line_tracker
