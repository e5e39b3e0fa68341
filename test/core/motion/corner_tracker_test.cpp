#include "motion/corner_tracker.h"

#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// Blobs of all sizes, moved right and down by `shift` [px].
cv::Mat blobs(const cv::Point& shift) {
  const cv::Size size(kWidth + 100, kHeight + 100);
  cv::RNG random(5);
  cv::Mat sum(size, CV_32FC1, cv::Scalar(128.0));
  for (const int side : {8, 20, 50, 120}) {
    cv::Mat coarse(size.height / side + 1, size.width / side + 1, CV_32FC1);
    random.fill(coarse, cv::RNG::UNIFORM, -35.0, 35.0);
    cv::Mat fine;
    cv::resize(coarse, fine, size, 0.0, 0.0, cv::INTER_CUBIC);
    sum += fine;
  }
  cv::Mat image;
  sum(cv::Rect(50 - shift.x, 50 - shift.y, kWidth, kHeight)).convertTo(image, CV_8UC1);
  return image;
}

ImagePyramid pyramidOf(const cv::Mat& image) {
  ImagePyramid pyramid;
  pyramid.build(image, CornerTracker::kPyramidLevels);
  return pyramid;
}

std::size_t usedOf(const CornerTracker& corners) {
  std::size_t used = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) used += corners.corner(i).used ? 1 : 0;
  return used;
}

/// Follows the corners of one image into the next from where they were.
void follow(CornerTracker& corners, const cv::Mat& image) {
  for (std::size_t i = 0; i < corners.size(); ++i) corners.corner(i).expected = corners.corner(i).pixel;
  corners.follow(pyramidOf(image));
}

TEST(CornerTracker, FollowsCornersInBothDirections) {
  const cv::Point shift(37, -21);
  CornerTracker corners;
  const cv::Mat first = blobs({0, 0});
  corners.extractTemplates(pyramidOf(first));
  const std::size_t found = usedOf(corners);
  ASSERT_GE(found, 20U);
  std::vector<Eigen::Vector2f> before;
  for (std::size_t i = 0; i < corners.size(); ++i) before.push_back(corners.corner(i).pixel);
  follow(corners, blobs(shift));
  EXPECT_GE(usedOf(corners), found * 2 / 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners.corner(i).used) continue;
    EXPECT_LT((corners.corner(i).pixel - before[i] - Eigen::Vector2f(37.0F, -21.0F)).norm(), 0.2F)
        << before[i].transpose();
  }
}

TEST(CornerTracker, TakesNoCornerFromAnEdge) {
  cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(60));
  image(cv::Rect(0, 0, kWidth, kHeight / 2)).setTo(180);
  CornerTracker corners;
  corners.extractTemplates(pyramidOf(image));
  EXPECT_EQ(usedOf(corners), 0U);
}

TEST(CornerTracker, LosesWhatIsNoLongerThere) {
  CornerTracker corners;
  corners.extractTemplates(pyramidOf(blobs({0, 0})));
  follow(corners, cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(usedOf(corners), 0U);
}

TEST(CornerTracker, KeepsOneCornerInACell) {
  CornerTracker corners;
  const ImagePyramid pyramid = pyramidOf(blobs({0, 0}));
  corners.extractTemplates(pyramid);
  const std::size_t found = usedOf(corners);
  for (int image = 0; image < 2; ++image) {
    follow(corners, pyramid.level(0));
    corners.extractTemplates(pyramid);
  }
  EXPECT_LE(usedOf(corners), found) << "an image that stands still brings no new ones";
}

}  // namespace
}  // namespace tet_line_tracker
