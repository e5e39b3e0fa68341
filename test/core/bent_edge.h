#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// Camera of EuRoC, whose lens bends lines by up to some px (radial-tangential, k1 = -0.28).
inline std::shared_ptr<const CameraModel> eurocCamera() {
  CameraCalibration calibration;
  calibration.model = "plumb_bob";
  calibration.width = 752;
  calibration.height = 480;
  calibration.fx = 458.654;
  calibration.fy = 457.296;
  calibration.cx = 367.215;
  calibration.cy = 248.375;
  calibration.distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  return makeCameraModel(calibration);
}

/// An edge of space that is straight between two raw pixels, as a lens shows it.
class BentEdge {
 public:
  BentEdge(std::shared_ptr<const CameraModel> camera, const LineSegment& ends) : camera_(std::move(camera)) {
    const Eigen::Vector2d start = *camera_->normalize(ends.start.cast<double>());
    const Eigen::Vector2d way = (*camera_->normalize(ends.end.cast<double>()) - start).normalized();
    left_ = {way.y(), -way.x()};
    offset_ = left_.dot(start);
  }

  /// Distance of a raw pixel from the edge on the undistorted plane, times the focal length; positive to the
  /// left of the ends' direction on screen [px].
  double distance(const Eigen::Vector2f& pixel) const {
    const std::optional<Eigen::Vector2d> point = camera_->normalize(pixel.cast<double>());
    return point ? camera_->calibration().fx * (left_.dot(*point) - offset_) : std::nan("");
  }

  /// Image of the edge: 100 gray levels, `contrast` more on the left.
  cv::Mat image(float contrast, float noise, unsigned seed = 5) const {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal(0.0F, 1.0F);
    cv::Mat gray(camera_->calibration().height, camera_->calibration().width, CV_8UC1);
    for (int y = 0; y < gray.rows; ++y) {
      for (int x = 0; x < gray.cols; ++x) {
        const auto d = static_cast<float>(distance({static_cast<float>(x), static_cast<float>(y)}));
        gray.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
            100.0F + 0.5F * contrast * std::erf(d / 1.1F) + noise * normal(generator));
      }
    }
    return gray;
  }

 private:
  std::shared_ptr<const CameraModel> camera_;
  Eigen::Vector2d left_;
  double offset_;
};

}  // namespace tet_line_tracker
