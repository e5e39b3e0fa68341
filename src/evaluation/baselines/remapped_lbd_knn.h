#pragma once

#include <memory>
#include <optional>

#include "lbd_knn.h"

namespace tet_line_tracker {

/// LbdKnn as estimators with undistorted images use it: each image is remapped to a pinhole first, of the
/// same size and of the scale that the lens has at its axis. So it sees 79 degrees with EuRoC's lens and 118
/// of a lens of 190 degrees. Lines come back in the raw image. Without a camera it is LbdKnn.
class RemappedLbdKnn : public LbdKnn {
 public:
  using LbdKnn::LbdKnn;

 protected:
  void track(const cv::Mat& gray) override;
  bool isWanted(const LineSegment& segment) const override;

 private:
  void prepare(const cv::Size& size);
  /// Where a segment of the pinhole image is in the raw one; nothing beyond the model.
  std::optional<LineSegment> toRaw(const LineSegment& segment) const;

  std::shared_ptr<const CameraModel> prepared_for_;
  Eigen::Vector2d focal_{Eigen::Vector2d::Ones()};   ///< of the pinhole [px]
  Eigen::Vector2d centre_{Eigen::Vector2d::Zero()};  ///< likewise
  cv::Mat map_;                                      ///< raw pixel of each pixel of the pinhole
  cv::Mat remapped_;
};

}  // namespace tet_line_tracker
