#include "motion/rotation_aligner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

constexpr std::size_t kMaxPoints = 600;
constexpr std::size_t kMinPoints = 40;
constexpr std::size_t kMinMagnitude = 2;  // of a gradient that is more than noise [gray / 2 px]
constexpr float kMaxResidual = 20.0F;     // larger gray differences count as this one
constexpr float kMinStep = 2.5e-5F;       // the iterations end below this step on level 0 [rad]

/// Gray value between pixels; beyond the border, also at NaN, that of the outermost pixel.
float interpolate(const cv::Mat& image, float x, float y) {
  x = clampOrLow(x, 0.0F, static_cast<float>(image.cols) - 1.001F);
  y = clampOrLow(y, 0.0F, static_cast<float>(image.rows) - 1.001F);
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const std::uint8_t* upper = image.ptr<std::uint8_t>(row) + column;
  const std::uint8_t* lower = upper + image.step[0];
  const float a = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
  const float b = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
  return a + fy * (b - a);
}

}  // namespace

void RotationAligner::setCamera(const CameraModel& camera, const cv::Size& size) {
  const double scale = static_cast<double>(ImagePyramid::scale(level_));
  const auto halved = [this](int side) {
    for (int j = 0; j < level_; ++j) side = (side + 1) / 2;
    return side;
  };
  width_ = halved(size.width);
  height_ = halved(size.height);
  clearTemplate();
  jacobians_.assign(static_cast<std::size_t>(width_ * height_), Eigen::Matrix<float, 2, 3>::Zero());
  magnitudes_.assign(jacobians_.size(), 0);
  constexpr double kSmallAngle = 1e-3;  // [rad]
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::optional<Eigen::Vector3d> ray = camera.unproject(Eigen::Vector2d(x, y) / scale);
      if (!ray) continue;
      Eigen::Matrix<double, 2, 3> jacobian;
      bool seen = true;
      for (int axis = 0; axis < 3 && seen; ++axis) {
        const Eigen::Matrix3d forward =
            Eigen::AngleAxisd(kSmallAngle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
        const std::optional<Eigen::Vector2d> ahead = camera.project(forward * *ray);
        const std::optional<Eigen::Vector2d> behind = camera.project(forward.transpose() * *ray);
        seen = ahead && behind;
        if (seen) jacobian.col(axis) = scale * (*ahead - *behind) / (2.0 * kSmallAngle);
      }
      if (!seen) continue;
      const Eigen::Matrix<float, 2, 3> single = jacobian.cast<float>();
      if (single.allFinite()) jacobians_[static_cast<std::size_t>(y * width_ + x)] = single;
    }
  }
}

void RotationAligner::setFirst(const ImagePyramid& first) {
  clearTemplate();
  if (first.levels() <= level_ || first.level(level_).size() != cv::Size(width_, height_)) return;
  first.level(level_).copyTo(first_);
  is_extracted_ = false;
}

bool RotationAligner::hasTemplate() {
  if (!is_extracted_) extractTemplate();
  return !points_.empty();
}

void RotationAligner::extractTemplate() {
  is_extracted_ = true;
  const cv::Mat& image = first_;
  // The pixels with the steepest gradients: a threshold from the histogram of their magnitudes.
  for (int y = 1; y + 1 < height_; ++y) {
    const std::uint8_t* above = image.ptr<std::uint8_t>(y - 1);
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1);
    std::uint16_t* magnitudes = magnitudes_.data() + y * width_;
    for (int x = 1; x + 1 < width_; ++x) {
      magnitudes[x] =
          static_cast<std::uint16_t>(std::abs(row[x + 1] - row[x - 1]) + std::abs(below[x] - above[x]));
    }
  }
  std::array<std::size_t, 2 * 255 + 1> histogram{};
  for (const std::uint16_t magnitude : magnitudes_) ++histogram[magnitude];
  std::size_t threshold = histogram.size();
  for (std::size_t points = 0; threshold > kMinMagnitude && points < kMaxPoints;) {
    points += histogram[--threshold];
  }
  float gray_sum = 0.0F;
  Eigen::Vector3f gradient_sum = Eigen::Vector3f::Zero();
  for (int y = 1; y + 1 < height_; ++y) {
    for (int x = 1; x + 1 < width_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * width_ + x);
      if (magnitudes_[i] < threshold) continue;
      const std::uint8_t* row = image.ptr<std::uint8_t>(y) + x;
      const float dx = 0.5F * static_cast<float>(row[1] - row[-1]);
      const float dy =
          0.5F * static_cast<float>(image.at<std::uint8_t>(y + 1, x) - image.at<std::uint8_t>(y - 1, x));
      Point point;
      point.pixel = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      point.jacobian = jacobians_[i];
      point.gray_gradient = point.jacobian.transpose() * Eigen::Vector2f(dx, dy);
      point.gray = static_cast<float>(*row);
      gray_sum += point.gray;
      gradient_sum += point.gray_gradient;
      points_.push_back(point);
    }
  }
  if (points_.size() < kMinPoints) {
    points_.clear();
    return;
  }
  // Take from the gradients what a change of gain and offset would explain.
  const float count = static_cast<float>(points_.size());
  float gray_square = 0.0F;
  Eigen::Vector3f gray_times_gradient = Eigen::Vector3f::Zero();
  for (Point& point : points_) {
    point.gray -= gray_sum / count;
    point.gray_gradient -= gradient_sum / count;
    gray_square += point.gray * point.gray;
    gray_times_gradient += point.gray * point.gray_gradient;
  }
  gray_variance_ = gray_square / count;
  Eigen::Matrix3f hessian = Eigen::Matrix3f::Zero();
  for (Point& point : points_) {
    point.gray_gradient -= gray_times_gradient * (point.gray / (gray_square + 1.0F));
    hessian += point.gray_gradient * point.gray_gradient.transpose();
  }
  // A direction that the texture does not show stays where it starts.
  hessian.diagonal().array() += 1e-4F * hessian.trace() + 1.0F;
  inverse_hessian_ = hessian.inverse();
}

RotationAligner::Brightness RotationAligner::sample(const cv::Mat& second, const Eigen::Vector3f& rotation) {
  samples_.resize(points_.size());
  float sum = 0.0F;
  float sum_times_gray = 0.0F;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    const Eigen::Vector2f pixel = point.pixel + point.jacobian * rotation;
    samples_[i] = interpolate(second, pixel.x(), pixel.y());
    sum += samples_[i];
    sum_times_gray += samples_[i] * point.gray;
  }
  const float count = static_cast<float>(points_.size());
  const float gain = std::clamp(sum_times_gray / (count * gray_variance_ + 1.0F), 0.3F, 3.0F);
  return {1.0F / gain, sum / count};
}

float RotationAligner::cost(const ImagePyramid& second, const Eigen::Vector3f& rotation) {
  const Brightness brightness = sample(second.level(level_), rotation);
  float sum = 0.0F;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const float difference = (samples_[i] - brightness.offset) * brightness.inverse_gain - points_[i].gray;
    sum += std::min(kMaxResidual, std::abs(difference));
  }
  return sum / static_cast<float>(points_.size());
}

Eigen::Vector3f RotationAligner::align(const ImagePyramid& second, const Eigen::Vector3f& start,
                                       int max_iterations) {
  Eigen::Vector3f rotation = start;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Brightness brightness = sample(second.level(level_), rotation);
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const float difference = (samples_[i] - brightness.offset) * brightness.inverse_gain - points_[i].gray;
      gradient += points_[i].gray_gradient * std::clamp(difference, -kMaxResidual, kMaxResidual);
    }
    const Eigen::Vector3f step = -(inverse_hessian_ * gradient);
    rotation += step;
    if (step.norm() * ImagePyramid::scale(level_) < kMinStep) break;
  }
  return rotation;
}

}  // namespace tet_line_tracker
