#include "camera/field_of_view.h"

#include <utility>

#include "geometry/clamp.h"
#include "geometry/last_inside.h"

namespace tet_line_tracker {
namespace {

constexpr float kBorderStep = 4.0F;  ///< between the pixels of the border that are tried [px]

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
  const auto sees = [this](const Eigen::Vector2f& pixel) { return contains(pixel); };
  LineSegment cut = segment;
  if (!start_in_view) cut.start = lastInside(curve, in_view, 0.0F, sees);
  if (!end_in_view) cut.end = lastInside(curve, in_view, 1.0F, sees);
  if (cut.length() < min_length) return std::nullopt;
  return cut;
}

bool FieldOfView::contains(const Eigen::Vector2f& pixel) const {
  return !camera_ || camera_->normalize(pixel.cast<double>()).has_value();
}

}  // namespace tet_line_tracker
