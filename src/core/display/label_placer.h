#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"

namespace tet_line_tracker {

/// Finds room for labels beside lines: where no line runs and no other label is.
class LabelPlacer {
 public:
  /// For an image of this size, of which nothing is taken yet [px].
  explicit LabelPlacer(const cv::Size& size);

  void take(const LineCurve& line);
  void take(const cv::Rect& area);

  /// Lower left corner of a label of `extent` beside `line`, at its middle or else nearer to an end; that
  /// room is then taken. Nothing where there is no room inside the image.
  std::optional<cv::Point> place(const LineCurve& line, const cv::Size& extent);

 private:
  /// The pixels of the coarse mask that an area of the image touches; empty when it is not inside the image.
  cv::Rect cellsOf(const cv::Rect& area) const;

  cv::Size size_;
  cv::Mat taken_;  ///< coarse mask of the image, not 0: taken
};

}  // namespace tet_line_tracker
