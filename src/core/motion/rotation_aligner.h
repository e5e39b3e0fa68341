#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/image/image_pyramid.h"

namespace tet_line_tracker {

/// Direct alignment of one pyramid level of two images by a rotation of the camera, with gain and offset of
/// the gray values: Gauss-Newton on the pixels with the steepest gradients of the first image, the template.
/// Rotations are rotation vectors (axis times angle) [rad]; image motion is taken linear in them, which is
/// exact enough at the coarse levels it is made for.
class RotationAligner {
 public:
  /// `level`: of the pyramid.
  explicit RotationAligner(int level) : level_(level) {}

  /// Lens and size of the original image [px]; forgets the template.
  void setCamera(const CameraModel& camera, const cv::Size& size);

  /// Takes the first image. Its template is made when it is asked for: a trusted gyroscope needs none.
  void setFirst(const ImagePyramid& first);
  /// False when the first image has too little texture or another size than the camera; then there is nothing
  /// to align.
  bool hasTemplate();
  void clearTemplate() {
    points_.clear();
    is_extracted_ = true;
  }

  /// Mean absolute gray difference between the template and `second` rotated back by `rotation`, large ones
  /// cut off.
  float cost(const ImagePyramid& second, const Eigen::Vector3f& rotation);

  /// The rotation near `start` at which the images fit best.
  Eigen::Vector3f align(const ImagePyramid& second, const Eigen::Vector3f& start, int max_iterations);

 private:
  struct Point {
    Eigen::Vector2f pixel;                ///< [px of the level]
    Eigen::Matrix<float, 2, 3> jacobian;  ///< of the pixel by the rotation vector [px / rad]
    Eigen::Vector3f gray_gradient;  ///< of the gray value by the rotation vector, the part that gain and
                                    ///< offset would explain taken out [gray / rad]
    float gray;                     ///< less the mean of all points
  };
  struct Brightness {
    float inverse_gain, offset;  ///< template = inverse_gain * (second - offset)
  };

  /// points_ of first_.
  void extractTemplate();

  /// Gray values of `second` at the points moved by `rotation`, and its change of brightness.
  Brightness sample(const cv::Mat& second, const Eigen::Vector3f& rotation);

  int level_;
  int width_{0}, height_{0};
  std::vector<Eigen::Matrix<float, 2, 3>> jacobians_;  ///< of every pixel of the level
  cv::Mat first_;                                      ///< level of the first image
  bool is_extracted_{true};                            ///< points_ are those of first_
  std::vector<Point> points_;
  std::vector<std::uint16_t> magnitudes_;  ///< of the gradient, of every pixel; 0 at the border [gray / 2 px]
  std::vector<float> samples_;
  float gray_variance_{0.0F};
  Eigen::Matrix3f inverse_hessian_{Eigen::Matrix3f::Identity()};
};

}  // namespace tet_line_tracker
