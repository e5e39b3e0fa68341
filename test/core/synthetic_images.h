#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// Smooth texture without repetition within a patch: known at every sub-pixel point. About 20..235.
inline float smoothTexture(float x, float y) {
  return 128.0F + 35.0F * std::sin(0.13F * x + 0.05F * y) + 35.0F * std::sin(0.12F * y - 0.04F * x + 1.0F) +
         22.0F * std::sin(0.41F * x - 0.13F * y + 2.0F) + 22.0F * std::sin(0.11F * x + 0.39F * y);
}

/// smoothTexture moved right and down by `shift` [px], rounded to 8 bits.
inline cv::Mat smoothImage(int width, int height, const Eigen::Vector2f& shift) {
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float gray = smoothTexture(static_cast<float>(x) - shift.x(), static_cast<float>(y) - shift.y());
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(gray));
    }
  }
  return image;
}

/// Boxes of different gray on gray ground, edges anti-aliased by area: how much of a pixel a box covers is
/// exact. The whole picture is moved right and down by `shift` [px]. Sides of the boxes: at least 60 px.
inline cv::Mat boxesImage(int width, int height, const Eigen::Vector2f& shift) {
  struct Box {
    float left, top, right, bottom, gray;
  };
  static const Box boxes[] = {{60.3F, 40.6F, 180.2F, 130.9F, 210.0F},
                              {230.5F, 60.1F, 330.8F, 220.4F, 40.0F},
                              {90.7F, 180.2F, 190.1F, 300.6F, 170.0F},
                              {380.4F, 90.3F, 520.9F, 170.2F, 225.0F},
                              {400.2F, 240.8F, 500.6F, 340.5F, 60.0F}};
  const auto covered = [](float pixel, float low, float high) {
    return std::clamp(std::min(pixel + 0.5F, high) - std::max(pixel - 0.5F, low), 0.0F, 1.0F);
  };
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float gray = 110.0F;
      for (const Box& box : boxes) {
        const float share = covered(static_cast<float>(x), box.left + shift.x(), box.right + shift.x()) *
                            covered(static_cast<float>(y), box.top + shift.y(), box.bottom + shift.y());
        gray += share * (box.gray - gray);
      }
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(gray));
    }
  }
  return image;
}

}  // namespace tet_line_tracker
