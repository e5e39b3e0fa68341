#include "line3d_array_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tet_line_tracker {
namespace {

constexpr Colour kLiveColour{0.25F, 0.9F, 0.35F, 1.0F};
constexpr Colour kFinishedColour{0.25F, 0.6F, 1.0F, 1.0F};

/// NaN when either end has none.
double sigmaOf(const Line3D& line) {
  if (std::isnan(line.sigma_start) || std::isnan(line.sigma_end))
    return std::numeric_limits<double>::quiet_NaN();
  return std::max(line.sigma_start, line.sigma_end);
}

bool isShown(const Line3D& line, const Line3DArrayStyle& style) {
  if (!(line.finished ? style.finished : style.live)) return false;
  return line.views >= style.min_views && !(sigmaOf(line) > style.max_sigma);
}

Eigen::Vector3f vectorOf(const geometry_msgs::Point& point) {
  return Eigen::Vector3d(point.x, point.y, point.z).cast<float>();
}

Colour colourOf(const Line3D& line, const Line3DArrayStyle& style) {
  if (style.colouring == Line3DArrayStyle::Colouring::kState) {
    return line.finished ? kFinishedColour : kLiveColour;
  }
  return colourOnScale(placeBetween(0.0, style.largest_sigma, sigmaOf(line)));
}

float heightOf(const ShownLine& line) {
  return 0.5F * (line.start.z() + line.end.z());
}

void colourByHeight(const Line3DArrayStyle& style, std::vector<ShownLine>& lines) {
  double lowest = style.lowest;
  double highest = style.highest;
  if (style.height_bounds_of_map) {
    const auto [low, high] = std::minmax_element(
        lines.begin(), lines.end(),
        [](const ShownLine& left, const ShownLine& right) { return heightOf(left) < heightOf(right); });
    if (low == lines.end()) return;
    lowest = heightOf(*low);
    highest = heightOf(*high);
  }
  for (ShownLine& line : lines) {
    const float alpha = line.colour.alpha;
    line.colour = colourOnScale(placeBetween(lowest, highest, heightOf(line)));
    line.colour.alpha = alpha;
  }
}

}  // namespace

ShownLines showMap(const Line3DArray& map, const Line3DArrayStyle& style) {
  ShownLines shown;
  for (const Line3D& line : map.lines) {
    const Eigen::Vector3f start = vectorOf(line.start);
    const Eigen::Vector3f end = vectorOf(line.end);
    if (!start.allFinite() || !end.allFinite()) {
      ++shown.without_place;
      continue;
    }
    if (!isShown(line, style)) {
      ++shown.hidden;
      continue;
    }
    Colour colour = colourOf(line, style);
    colour.alpha = style.alpha;
    shown.lines.push_back({start, end, colour, style.ids ? std::to_string(line.id) : std::string()});
  }
  shown.shown = shown.lines.size();
  if (style.colouring == Line3DArrayStyle::Colouring::kHeight) colourByHeight(style, shown.lines);
  return shown;
}

}  // namespace tet_line_tracker
