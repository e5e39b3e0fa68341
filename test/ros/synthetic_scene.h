#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgproc.hpp>

namespace tet_line_tracker {
namespace synthetic_scene {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kFocal = 250.0;
constexpr char kFrame[] = "test_camera";

/// Gray picture of rectangles that drift and turn a little from image to image, anti-aliased.
inline cv::Mat picture(int image, int width = kWidth, int height = kHeight) {
  cv::Mat gray(height, width, CV_8UC1, cv::Scalar(70));
  const double angle = 0.2 + 0.002 * image;
  const double shift = 0.7 * image;
  const int across = width / 80;
  const int down = height / 80;
  for (int i = 0; i < across * down; ++i) {
    const double cx = 40.0 + 80.0 * (i % across) + shift * 0.3;
    const double cy = 40.0 + 80.0 * (i / across) + shift * 0.2;
    std::vector<cv::Point> corners;
    for (const auto& [x, y] : {std::pair{-27.0, -22.0}, {27.0, -22.0}, {27.0, 22.0}, {-27.0, 22.0}}) {
      corners.emplace_back(cvRound(16.0 * (cx + std::cos(angle) * x - std::sin(angle) * y)),
                           cvRound(16.0 * (cy + std::sin(angle) * x + std::cos(angle) * y)));
    }
    cv::fillConvexPoly(gray, corners, cv::Scalar(120 + 30 * (i % 5)), cv::LINE_AA, 4);
  }
  cv::GaussianBlur(gray, gray, cv::Size(0, 0), 1.0);
  return gray;
}

inline sensor_msgs::Image messageOf(const cv::Mat& pixels, const std::string& encoding,
                                    const ros::Time& stamp) {
  sensor_msgs::Image message;
  message.header.stamp = stamp;
  message.header.frame_id = kFrame;
  message.encoding = encoding;
  message.width = static_cast<std::uint32_t>(pixels.cols);
  message.height = static_cast<std::uint32_t>(pixels.rows);
  message.step = static_cast<std::uint32_t>(pixels.step);
  message.data.assign(pixels.datastart, pixels.dataend);
  return message;
}

inline sensor_msgs::Image monoMessage(int image, const ros::Time& stamp) {
  return messageOf(picture(image), sensor_msgs::image_encodings::MONO8, stamp);
}

/// Undistorted pinhole.
inline sensor_msgs::CameraInfo cameraInfo(const ros::Time& stamp) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = stamp;
  info.header.frame_id = kFrame;
  info.width = kWidth;
  info.height = kHeight;
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {kFocal, 0, kWidth / 2.0, 0, kFocal, kHeight / 2.0, 0, 0, 1};
  info.P = {kFocal, 0, kWidth / 2.0, 0, 0, kFocal, kHeight / 2.0, 0, 0, 0, 1, 0};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  return info;
}

}  // namespace synthetic_scene
}  // namespace tet_line_tracker
