#include "camera/field_of_view.h"

#include <cmath>
#include <utility>

#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

constexpr float kBorderStep = 4.0F;     ///< between the pixels of the border that are tried [px]
constexpr float kCutAccuracy = 0.005F;  ///< of a cut end [px]

}  // namespace

FieldOfView::FieldOfView(std::shared_ptr<const CameraModel> camera, const ImageBounds& bounds)
    : camera_(std::move(camera)) {
  if (!camera_) return;
  const Eigen::Vector2f corners[4] = {{bounds.min_x, bounds.min_y},
                                      {bounds.max_x, bounds.min_y},
                                      {bounds.max_x, bounds.max_y},
                                      {bounds.min_x, bounds.max_y}};
  for (int side = 0; side < 4; ++side) {
    const LineSegment border{corners[side], corners[(side + 1) % 4]};
    const int steps = 1 + static_cast<int>(border.length() / kBorderStep);
    for (int i = 0; i < steps; ++i) {
      if (!contains(border.at(static_cast<float>(i) / static_cast<float>(steps)))) return;
    }
  }
  camera_.reset();
}

std::optional<LineSegment> FieldOfView::clip(const LineCurve& curve, float min_length) const {
  const LineSegment& segment = curve.chord;
  if (!camera_) return segment;
  const bool start_in_view = contains(segment.start);
  const bool end_in_view = contains(segment.end);
  if (start_in_view && end_in_view) return segment;

  float in_view = start_in_view ? 0.0F : 1.0F;
  if (!start_in_view && !end_in_view) {
    // Steps that a part of min_length cannot slip through.
    const int steps = 1 + static_cast<int>(clampOrLow(segment.length() / min_length, 0.0F, 1e4F));
    int i = 1;
    while (i < steps && !contains(curve.at(static_cast<float>(i) / static_cast<float>(steps)))) ++i;
    if (i >= steps) return std::nullopt;
    in_view = static_cast<float>(i) / static_cast<float>(steps);
  }
  LineSegment cut = segment;
  if (!start_in_view) cut.start = lastInView(curve, in_view, 0.0F);
  if (!end_in_view) cut.end = lastInView(curve, in_view, 1.0F);
  if (cut.length() < min_length) return std::nullopt;
  return cut;
}

bool FieldOfView::contains(const Eigen::Vector2f& pixel) const {
  return !camera_ || camera_->normalize(pixel.cast<double>()).has_value();
}

/// Last point of `curve` in view on the way from the fraction `in_view` to the fraction `beyond`.
Eigen::Vector2f FieldOfView::lastInView(const LineCurve& curve, float in_view, float beyond) const {
  Eigen::Vector2f last = curve.at(in_view);
  while (std::abs(beyond - in_view) * curve.chord.length() > kCutAccuracy) {
    const float middle = 0.5F * (in_view + beyond);
    if (middle == in_view || middle == beyond) break;  // float knows nothing in between
    const Eigen::Vector2f point = curve.at(middle);
    if (contains(point)) {
      last = point;
      in_view = middle;
    } else {
      beyond = middle;
    }
  }
  return last;
}

}  // namespace tet_line_tracker
