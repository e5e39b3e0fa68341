#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/image/image_pyramid.h"

namespace tet_line_tracker {

/// Direct alignment of one pyramid level of two images by a rotation of the camera, with gain and offset of
/// the gray values: Gauss-Newton on the pixels with the steepest gradients of the first image. Rotations are
/// vectors of axis times angle [rad]; image motion is taken linear in them, which is exact enough at the
/// coarse levels it is made for.
class RotationAligner {
 public:
  /// `level`: of the pyramid.
  explicit RotationAligner(int level) : level_(level) {}

  /// Lens and size of the original image; forgets the first image.
  void setCamera(const CameraModel& camera);

  /// Takes the first image. False when it has too little texture.
  bool describe(const ImagePyramid& first);

  /// Mean absolute gray difference between the first image and `second` turned back by `turn`, large ones cut
  /// off.
  float cost(const ImagePyramid& second, const Eigen::Vector3f& turn);

  /// The turn near `start` at which the images fit best.
  Eigen::Vector3f align(const ImagePyramid& second, const Eigen::Vector3f& start, int max_iterations);

  bool hasImage() const { return !points_.empty(); }
  void forget() { points_.clear(); }

 private:
  struct Point {
    Eigen::Vector2f place;                ///< [px of the level]
    Eigen::Matrix<float, 2, 3> movement;  ///< of the pixel by a turn [px / rad]
    Eigen::Vector3f slope;  ///< of the gray value by a turn [gray / rad], gain and offset taken out
    float gray;             ///< less the mean of all points
  };
  struct Light {
    float shrink, offset;  ///< first = shrink * (second - offset)
  };

  /// Gray values of `second` at the points moved by `turn`, and what light has changed.
  Light read(const cv::Mat& second, const Eigen::Vector3f& turn);

  int level_;
  int width_{0}, height_{0};
  std::vector<Eigen::Matrix<float, 2, 3>> movements_;  ///< of every pixel of the level
  std::vector<Point> points_;
  std::vector<std::uint16_t> steepness_;  ///< of every pixel; 0 at the border [gray over 2 px]
  std::vector<float> values_;
  float gray_square_{0.0F};  ///< mean of gray^2
  Eigen::Matrix3f normal_inverse_{Eigen::Matrix3f::Identity()};
};

}  // namespace tet_line_tracker
