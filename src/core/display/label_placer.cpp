#include "display/label_placer.h"

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "display/drawing.h"
#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

constexpr int kCell = 4;            // of the mask [px]
constexpr int kMargin = 1;          // around a label [px]
constexpr float kClearance = 4.0F;  // of a label from its line [px]

}  // namespace

LabelPlacer::LabelPlacer(const cv::Size& size)
    : size_(size),
      taken_((size.height + kCell - 1) / kCell, (size.width + kCell - 1) / kCell, CV_8UC1,
             cv::Scalar::all(0)) {}

void LabelPlacer::take(const LineCurve& line) {
  std::vector<cv::Point> points = fixedPoints(line);
  // The middle of the first cell is not that of the first pixel.
  constexpr int kHalf = 1 << (kDrawingShift - 1);
  for (cv::Point& point : points) {
    point = (point + cv::Point(kHalf, kHalf)) / kCell - cv::Point(kHalf, kHalf);
  }
  cv::polylines(taken_, points, false, cv::Scalar::all(255), 1, cv::LINE_8, kDrawingShift);
}

void LabelPlacer::take(const cv::Rect& area) {
  const cv::Rect cells = cellsOf(area & cv::Rect({0, 0}, size_));
  if (!cells.empty()) taken_(cells).setTo(255);
}

std::optional<cv::Point> LabelPlacer::place(const LineCurve& line, const cv::Size& extent) {
  const Eigen::Vector2f normal = line.chord.normal();
  // So far that the label's corner nearest to the line is clear of it.
  const float away = kClearance + 0.5F * (std::abs(normal.x()) * static_cast<float>(extent.width) +
                                          std::abs(normal.y()) * static_cast<float>(extent.height));
  for (const float fraction : {0.5F, 0.3F, 0.7F, 0.12F, 0.88F}) {
    for (const float side : {1.0F, -1.0F}) {
      const Eigen::Vector2f centre = line.at(fraction) + side * away * normal;
      const cv::Point corner(cvRound(clampOrLow(centre.x(), -1e6F, 1e6F)) - extent.width / 2,
                             cvRound(clampOrLow(centre.y(), -1e6F, 1e6F)) - extent.height / 2);
      const cv::Rect cells = cellsOf(
          {corner.x - kMargin, corner.y - kMargin, extent.width + 2 * kMargin, extent.height + 2 * kMargin});
      if (cells.empty() || cv::countNonZero(taken_(cells)) > 0) continue;
      taken_(cells).setTo(255);
      return cv::Point(corner.x, corner.y + extent.height);
    }
  }
  return std::nullopt;
}

cv::Rect LabelPlacer::cellsOf(const cv::Rect& area) const {
  if (area.empty() || (area & cv::Rect({0, 0}, size_)) != area) return {};
  const cv::Point first(area.x / kCell, area.y / kCell);
  const cv::Point last((area.x + area.width - 1) / kCell, (area.y + area.height - 1) / kCell);
  return {first, last + cv::Point(1, 1)};
}

}  // namespace tet_line_tracker
