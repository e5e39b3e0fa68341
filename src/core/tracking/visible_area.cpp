#include "tracking/visible_area.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace tet_line_tracker {

void VisibleArea::setCamera(std::shared_ptr<const CameraModel> camera) {
  if (camera != camera_) field_of_view_.reset();
  camera_ = std::move(camera);
}

void VisibleArea::setBorder(double border) {
  // The field of view is that inside the border.
  if (static_cast<float>(border) != border_) field_of_view_.reset();
  border_ = static_cast<float>(border);
}

void VisibleArea::setMask(const cv::Mat& mask) {
  if (!mask.empty() && mask.type() != CV_8UC1) {
    throw std::invalid_argument("mask is of OpenCV type " + std::to_string(mask.type()) +
                                ", needs 8-bit gray (type 0)");
  }
  mask_ = mask.clone();
}

void VisibleArea::setImageSize(const cv::Size& size) {
  if (size != size_) field_of_view_.reset();
  size_ = size;
  if (!field_of_view_) {
    field_of_view_.emplace(camera_, bounds());
    lens_ = LensBend(camera_, size.width, size.height);
  }
  mask_in_use_ = mask_.size() == size ? mask_ : cv::Mat();
}

bool VisibleArea::cutToBounds(float margin, LineCurve& line) const {
  const std::optional<LineSegment> inside = clip(line, bounds(margin));
  if (!inside) return false;
  if (inside->start != line.chord.start || inside->end != line.chord.end) line = lens_.curve(*inside);
  return true;
}

bool VisibleArea::cutToFieldOfView(float min_length, LineCurve& line, FrameStatistics& statistics) const {
  const std::optional<LineSegment> visible = field_of_view_->clip(line, min_length);
  if (!visible) {
    ++statistics.lines_left_out;
    return false;
  }
  if (visible->start != line.chord.start || visible->end != line.chord.end) {
    ++statistics.lines_cut;
    line = lens_.curve(*visible);
  }
  return true;
}

std::uint8_t VisibleArea::cutsOf(const LineCurve& line) const {
  // A little beyond its end: is there anything of the image where the edge could go on?
  constexpr float kBeyond = 3.0F;
  const float step = kBeyond / line.chord.length();
  unsigned cuts = 0;
  if (!sees(line.at(-step))) cuts |= kStartCut;
  if (!sees(line.at(1.0F + step))) cuts |= kEndCut;
  return static_cast<std::uint8_t>(cuts);
}

bool VisibleArea::sees(const Eigen::Vector2f& pixel) const {
  // Written so that NaN is not seen.
  if (!bounds().contains(pixel) || !field_of_view_->contains(pixel)) return false;
  if (mask_in_use_.empty()) return true;
  const auto x = static_cast<int>(std::lround(pixel.x()));
  const auto y = static_cast<int>(std::lround(pixel.y()));
  return mask_in_use_.at<std::uint8_t>(y, x) != 0;
}

}  // namespace tet_line_tracker
