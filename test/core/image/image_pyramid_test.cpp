#include "tet_line_tracker/image/image_pyramid.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

cv::Mat noise(int width, int height) {
  std::mt19937 generator(7);
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(generator() & 255U);
  }
  return image;
}

/// The paper's equation, pixel by pixel.
int halved(const cv::Mat& image, int x, int y) {
  const auto at = [&image](int px, int py) {
    return static_cast<int>(
        image.at<std::uint8_t>(std::clamp(py, 0, image.rows - 1), std::clamp(px, 0, image.cols - 1)));
  };
  const int u = 2 * x;
  const int v = 2 * y;
  const int sum = 4 * at(u, v) + 2 * (at(u + 1, v) + at(u - 1, v) + at(u, v + 1) + at(u, v - 1)) +
                  at(u + 1, v + 1) + at(u - 1, v + 1) + at(u + 1, v - 1) + at(u - 1, v - 1);
  return (sum + 8) / 16;
}

TEST(ImagePyramid, EveryLevelIsThePapersEquationOfTheOneBelowAtEvenAndOddSizes) {
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(65, 47), cv::Size(101, 33), cv::Size(752, 480),
                              cv::Size(33, 129), cv::Size(1241, 376)}) {
    const cv::Mat image = noise(size.width, size.height);
    ImagePyramid pyramid;
    pyramid.build(image, 3);
    for (int j = 1; j < pyramid.levels(); ++j) {
      const cv::Mat& below = pyramid.level(j - 1);
      const cv::Mat& level = pyramid.level(j);
      ASSERT_EQ(level.cols, (below.cols + 1) / 2);
      ASSERT_EQ(level.rows, (below.rows + 1) / 2);
      for (int y = 0; y < level.rows; ++y) {
        for (int x = 0; x < level.cols; ++x) {
          ASSERT_EQ(level.at<std::uint8_t>(y, x), halved(below, x, y))
              << "at " << x << ", " << y << " of level " << j << ", size " << size;
        }
      }
    }
  }
}

TEST(ImagePyramid, APixelOfALevelLiesOnTheDoubleCoordinatesOfTheLevelBelowWithoutAShift) {
  // A ramp keeps its values under the symmetric kernel, so any shift of the sampling would show as an offset.
  cv::Mat ramp(64, 128, CV_8UC1);
  for (int y = 0; y < ramp.rows; ++y) {
    for (int x = 0; x < ramp.cols; ++x) ramp.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(x + y);
  }
  ImagePyramid pyramid;
  pyramid.build(ramp, 3);
  for (int j = 1; j < 3; ++j) {
    const float scale = ImagePyramid::scale(j);
    for (int y = 2; y < pyramid.level(j).rows - 2; ++y) {
      for (int x = 2; x < pyramid.level(j).cols - 2; ++x) {
        EXPECT_EQ(static_cast<float>(pyramid.level(j).at<std::uint8_t>(y, x)),
                  static_cast<float>(x + y) / scale);
      }
    }
  }
}

TEST(ImagePyramid, ReferencesTheImageAndReusesItsBuffers) {
  const cv::Mat image = noise(320, 240);
  ImagePyramid pyramid;
  pyramid.build(image, 3);
  EXPECT_EQ(pyramid.level(0).data, image.data);
  const unsigned char* buffer = pyramid.level(1).data;
  pyramid.build(image, 3);
  EXPECT_EQ(pyramid.level(1).data, buffer);
}

TEST(ImagePyramid, MakesFewerLevelsOfASmallImage) {
  ImagePyramid pyramid;
  pyramid.build(noise(40, 40), 8);
  EXPECT_EQ(pyramid.levels(), 2);
  pyramid.build(noise(5, 5), 3);
  EXPECT_EQ(pyramid.levels(), 1);
}

TEST(ImagePyramid, ReadsAPartOfALargerImage) {
  const cv::Mat image = noise(200, 100);
  const cv::Mat part = image(cv::Rect(31, 17, 101, 67));
  ImagePyramid of_part, of_copy;
  of_part.build(part, 3);
  of_copy.build(part.clone(), 3);
  for (int j = 1; j < 3; ++j) EXPECT_EQ(cv::countNonZero(of_part.level(j) != of_copy.level(j)), 0);
}

}  // namespace
}  // namespace tet_line_tracker
