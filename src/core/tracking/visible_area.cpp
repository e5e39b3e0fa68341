#include "tracking/visible_area.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace tet_line_tracker {

void VisibleArea::setCamera(std::shared_ptr<const CameraModel> camera) {
  if (camera != camera_) field_of_view_.reset();
  camera_ = std::move(camera);
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
  if (!field_of_view_) field_of_view_.emplace(camera_, bounds());
  mask_in_use_ = mask_.size() == size ? mask_ : cv::Mat();
}

bool VisibleArea::cutToFieldOfView(float min_length, LineSegment& segment,
                                   FrameStatistics& statistics) const {
  const std::optional<LineSegment> visible = field_of_view_->clip(segment, min_length);
  if (!visible) {
    ++statistics.lines_left_out;
    return false;
  }
  if (visible->start != segment.start || visible->end != segment.end) ++statistics.lines_cut;
  segment = *visible;
  return true;
}

}  // namespace tet_line_tracker
