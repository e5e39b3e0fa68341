#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace tet_line_tracker {

struct Rectangle {
  float left, top, right, bottom, gray;
};

/// The sides of a square around (`x`, `y`) of `side` px.
inline Rectangle squareAt(float x, float y, float side, float gray) {
  return {x - 0.5F * side, y - 0.5F * side, x + 0.5F * side, y + 0.5F * side, gray};
}

/// How a picture lies in an image: scaled and turned about the middle of the image, then shifted.
struct Similarity {
  float scale{1.0F};
  float angle{0.0F};                               ///< clockwise on screen [rad]
  Eigen::Vector2f shift{Eigen::Vector2f::Zero()};  ///< [px]
};

/// Rectangles on gray 110, later ones over earlier ones, with anti-aliased edges.
inline cv::Mat rectanglesImage(const cv::Size& size, const std::vector<Rectangle>& rectangles,
                               const Similarity& placed = Similarity()) {
  const Eigen::Vector2f middle(0.5F * static_cast<float>(size.width - 1),
                               0.5F * static_cast<float>(size.height - 1));
  const float c = std::cos(placed.angle);
  const float s = std::sin(placed.angle);
  const float half_pixel = 0.5F / placed.scale;
  const auto covered = [&](float place, float low, float high) {
    return std::clamp((std::min(place + half_pixel, high) - std::max(place - half_pixel, low)) * placed.scale,
                      0.0F, 1.0F);
  };
  cv::Mat image(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Eigen::Vector2f p =
          (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - placed.shift - middle) /
          placed.scale;
      const Eigen::Vector2f place = middle + Eigen::Vector2f(c * p.x() + s * p.y(), c * p.y() - s * p.x());
      float gray = 110.0F;
      for (const Rectangle& r : rectangles) {
        const float share = covered(place.x(), r.left, r.right) * covered(place.y(), r.top, r.bottom);
        gray += share * (r.gray - gray);
      }
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(gray));
    }
  }
  return image;
}

}  // namespace tet_line_tracker
