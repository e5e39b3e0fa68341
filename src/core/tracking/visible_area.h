#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <opencv2/core.hpp>

#include "camera/field_of_view.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/geometry/line_segment.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Where in the images of an epoch lines may lie: inside the border, on the mask, in the field of view of the
/// camera.
class VisibleArea {
 public:
  /// `border`: margin of the image without endpoints [px].
  explicit VisibleArea(double border) : border_(static_cast<float>(border)) {}

  /// For the images to come [px].
  void setBorder(double border);
  /// nullptr: everything can be normalised, or nothing needs to be.
  void setCamera(std::shared_ptr<const CameraModel> camera);
  /// Counts for images of its size; empty: no mask. Throws std::invalid_argument unless it is 8-bit gray.
  void setMask(const cv::Mat& mask);
  /// Prepares for images of this size [px].
  void setImageSize(const cv::Size& size);

  /// Where endpoints may lie, `margin` px less on each side.
  ImageBounds bounds(float margin = 0.0F) const {
    return ImageBounds::ofImage(size_.width, size_.height, border_ + margin);
  }
  /// 8-bit, of the size of the image: lines lie where it is not zero; empty: everywhere.
  const cv::Mat& mask() const { return mask_in_use_; }

  /// How the lens bends lines in images of the present size.
  const LensBend& lens() const { return lens_; }

  /// Cuts `line` to the bounds, less `margin` px. False when nothing is left; the line then stays as it is.
  bool cutToBounds(float margin, LineCurve& line) const;
  /// Cuts `line` to what can be normalised and counts that. False when less than `min_length` is left [px];
  /// the line then stays as it is.
  bool cutToFieldOfView(float min_length, LineCurve& line, FrameStatistics& statistics) const;
  /// LineCut bits of a line: which ends lie where bounds, mask or field of view end.
  std::uint8_t cutsOf(const LineCurve& line) const;
  /// Whether a line may go there: in the bounds, on the mask, in the field of view.
  bool sees(const Eigen::Vector2f& pixel) const;

 private:
  float border_;
  cv::Size size_;
  std::shared_ptr<const CameraModel> camera_;
  std::optional<FieldOfView> field_of_view_;  ///< of camera_ in images of size_
  LensBend lens_;                             ///< likewise
  cv::Mat mask_, mask_in_use_;
};

}  // namespace tet_line_tracker
