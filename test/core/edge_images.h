#pragma once

#include <cmath>
#include <random>

#include <opencv2/core.hpp>

namespace tet_line_tracker {

/// Half plane, bright where nx (x - cx) + ny (y - cy) > offset, each pixel the mean of its area.
inline cv::Mat halfPlane(cv::Size size, double angle, double offset, int dark = 60, int bright = 180) {
  constexpr int kSub = 8;
  cv::Mat image(size, CV_8UC1);
  const double nx = std::cos(angle);
  const double ny = std::sin(angle);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      int inside = 0;
      for (int j = 0; j < kSub; ++j) {
        for (int i = 0; i < kSub; ++i) {
          const double px = x + (i + 0.5) / kSub - 0.5 - (size.width - 1) / 2.0;
          const double py = y + (j + 0.5) / kSub - 0.5 - (size.height - 1) / 2.0;
          inside += nx * px + ny * py > offset ? 1 : 0;
        }
      }
      image.at<uchar>(y, x) =
          cv::saturate_cast<uchar>(dark + (bright - dark) * inside / static_cast<double>(kSub * kSub));
    }
  }
  return image;
}

inline cv::Mat noiseImage(cv::Size size, double mean, double sigma, unsigned seed) {
  cv::Mat image(size, CV_8UC1);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(mean, sigma);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at<uchar>(y, x) = cv::saturate_cast<uchar>(noise(random));
  }
  return image;
}

inline cv::Mat withNoise(const cv::Mat& image, double sigma, unsigned seed) {
  cv::Mat noisy(image.size(), CV_8UC1);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      noisy.at<uchar>(y, x) = cv::saturate_cast<uchar>(image.at<uchar>(y, x) + noise(random));
    }
  }
  return noisy;
}

}  // namespace tet_line_tracker
