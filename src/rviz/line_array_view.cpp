#include "line_array_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Cholesky>

namespace tet_line_tracker {
namespace {

bool isNormalized(const Line& line) {
  return std::isfinite(line.start_normalized[0]) && std::isfinite(line.start_normalized[1]) &&
         std::isfinite(line.end_normalized[0]) && std::isfinite(line.end_normalized[1]);
}

bool hasPixels(const Line& line) {
  return std::isfinite(line.start_px[0]) && std::isfinite(line.start_px[1]) &&
         std::isfinite(line.end_px[0]) && std::isfinite(line.end_px[1]);
}

Eigen::Vector2d pixelOf(const Line::_start_px_type& place) {
  return {place[0], place[1]};
}

/// Where the lines of an image are drawn.
class Canvas {
 public:
  Canvas(const PosedLines& image, const LineArrayStyle& style)
      : pose_(image.pose), depth_(style.depth), raw_(style.raw.get()) {}

  bool hasPlaceFor(const Line& line) const { return raw_ != nullptr ? hasPixels(line) : isNormalized(line); }

  Eigen::Vector3f start(const Line& line) const {
    return raw_ != nullptr ? overPixel(pixelOf(line.start_px))
                           : onPlane({line.start_normalized[0], line.start_normalized[1]});
  }
  Eigen::Vector3f end(const Line& line) const {
    return raw_ != nullptr ? overPixel(pixelOf(line.end_px))
                           : onPlane({line.end_normalized[0], line.end_normalized[1]});
  }
  std::vector<Eigen::Vector3f> between(const Line& line) const {
    std::vector<Eigen::Vector3f> points;
    if (raw_ == nullptr || !isNormalized(line)) return points;
    for (const Eigen::Vector2d& pixel : raw_->between(pixelOf(line.start_px), pixelOf(line.end_px))) {
      points.push_back(overPixel(pixel));
    }
    return points;
  }

  /// A point of z = 1 of the optical frame, moved to the plane.
  Eigen::Vector3f onPlane(const Eigen::Vector2d& normalized) const {
    return inFixedFrame(depth_ * normalized.homogeneous());
  }
  Eigen::Vector3f overPixel(const Eigen::Vector2d& pixel) const {
    return inFixedFrame(raw_->pointOver(pixel, depth_));
  }
  /// From where the plane is seen.
  Eigen::Vector3f eye() const {
    return inFixedFrame(raw_ != nullptr ? raw_->pointOver({0.0, 0.0}, 0.0) : Eigen::Vector3d::Zero());
  }

 private:
  Eigen::Vector3f inFixedFrame(const Eigen::Vector3d& point) const { return (pose_ * point).cast<float>(); }

  const Eigen::Isometry3d& pose_;
  double depth_;
  const RawPicture* raw_;
};

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

/// Corners of the image on z = 1, by the pinhole camera that fits the ends of the lines best; none when there
/// are too few lines.
std::optional<std::array<Eigen::Vector2d, 4>> fittedCorners(const LineArray& image) {
  LinearFit x;
  LinearFit y;
  for (const Line& line : image.lines) {
    if (!isNormalized(line)) continue;
    x.add(line.start_px[0], line.start_normalized[0]);
    x.add(line.end_px[0], line.end_normalized[0]);
    y.add(line.start_px[1], line.start_normalized[1]);
    y.add(line.end_px[1], line.end_normalized[1]);
  }
  constexpr std::size_t kMinEnds = 6;
  if (x.count < kMinEnds) return std::nullopt;
  const double left = x.valueAt(-0.5);
  const double right = x.valueAt(image.width - 0.5);
  const double top = y.valueAt(-0.5);
  const double bottom = y.valueAt(image.height - 0.5);
  return std::array<Eigen::Vector2d, 4>{{{left, top}, {right, top}, {right, bottom}, {left, bottom}}};
}

/// Corners of the image on the plane of the lines.
std::vector<Eigen::Vector3f> cornersOf(const PosedLines& image, const LineArrayStyle& style) {
  const Canvas canvas(image, style);
  std::vector<Eigen::Vector3f> corners;
  if (style.raw) {
    const double right = image.message->width - 0.5;
    const double bottom = image.message->height - 0.5;
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(-0.5, -0.5), {right, -0.5}, {right, bottom}, {-0.5, bottom}}) {
      corners.push_back(canvas.overPixel(pixel));
    }
  } else if (const auto fitted = fittedCorners(*image.message)) {
    for (const Eigen::Vector2d& corner : *fitted) corners.push_back(canvas.onPlane(corner));
  }
  return corners;
}

void addFrustum(const PosedLines& image, const LineArrayStyle& style, std::vector<ShownLine>& lines) {
  const Eigen::Vector3f eye = Canvas(image, style).eye();
  const std::vector<Eigen::Vector3f> corners = cornersOf(image, style);
  Colour colour = kUnknownColour;
  colour.alpha = style.alpha;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3f& next = corners[(i + 1) % corners.size()];
    if (!corners[i].allFinite() || !next.allFinite()) return;
    lines.push_back({corners[i], next, colour, {}});
    lines.push_back({eye, corners[i], colour, {}});
  }
}

}  // namespace

ShownLines showLines(const std::deque<PosedLines>& images, const LineArrayStyle& style) {
  ShownLines shown;
  if (images.empty()) return shown;

  std::unordered_map<std::uint64_t, TrailEnd> trails;
  const PosedLines& newest = images.back();
  const Canvas canvas(newest, style);
  for (const Line& line : newest.message->lines) {
    if (!canvas.hasPlaceFor(line)) {
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
    const Eigen::Vector3f start = canvas.start(line);
    const Eigen::Vector3f end = canvas.end(line);
    const std::string label = style.ids ? std::to_string(line.id) : std::string();
    shown.lines.push_back({start, end, colour, label, canvas.between(line)});
    trails[line.id] = {start, end, colour};
  }

  const std::size_t earlier = std::min(style.trail, images.size() - 1);
  for (std::size_t back = 1; back <= earlier; ++back) {
    const PosedLines& image = images[images.size() - 1 - back];
    const Canvas earlier_canvas(image, style);
    const auto opacity =
        static_cast<float>(1.0 - static_cast<double>(back) / static_cast<double>(style.trail + 1));
    for (const Line& line : image.message->lines) {
      const auto trail = trails.find(line.id);
      if (trail == trails.end() || !earlier_canvas.hasPlaceFor(line)) continue;
      Colour colour = trail->second.colour;
      colour.alpha *= opacity;
      const Eigen::Vector3f start = earlier_canvas.start(line);
      const Eigen::Vector3f end = earlier_canvas.end(line);
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
