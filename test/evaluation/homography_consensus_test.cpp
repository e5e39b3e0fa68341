#include "evaluation/homography_consensus.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

Eigen::Vector2f move(const Eigen::Matrix3d& homography, const Eigen::Vector2f& point) {
  return (homography * point.cast<double>().homogeneous()).hnormalized().cast<float>();
}

/// Lines all over an image of 640x480, moved by a homography; each is seen from elsewhere along itself after.
std::vector<LineMatch> matchesUnder(const Eigen::Matrix3d& homography, int count, double noise_px) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> x(20.0F, 620.0F), y(20.0F, 460.0F);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(noise_px));
  std::vector<LineMatch> matches;
  while (static_cast<int>(matches.size()) < count) {
    const LineSegment before{{x(random), y(random)}, {x(random), y(random)}};
    if (before.length() < 40.0F) continue;
    LineSegment after{move(homography, before.at(0.15F)), move(homography, before.at(1.1F))};
    const Eigen::Vector2f normal = after.normal();
    after.start += noise(random) * normal;
    after.end += noise(random) * normal;
    matches.push_back({before, after});
  }
  return matches;
}

Eigen::Matrix3d someHomography() {
  Eigen::Matrix3d homography;
  homography << 1.02, 0.03, 8.0, -0.02, 0.99, -5.0, 2e-5, -1e-5, 1.0;
  return homography;
}

TEST(HomographyInliers, HoldForLinesThatSlideAlongThemselves) {
  const auto inliers = homographyInliers(matchesUnder(someHomography(), 40, 0.2), 2.0);
  ASSERT_EQ(inliers.size(), 40U);
  EXPECT_EQ(std::count(inliers.begin(), inliers.end(), true), 40);
}

TEST(HomographyInliers, LeaveOutEveryWrongMatch) {
  std::vector<LineMatch> matches = matchesUnder(someHomography(), 60, 0.2);
  for (std::size_t i = 0; i < 20; ++i) {  // by 12 px to the side
    LineSegment& after = matches[3 * i].after;
    const Eigen::Vector2f by = 12.0F * after.normal();
    after.start += by;
    after.end += by;
  }
  const auto inliers = homographyInliers(matches, 2.0);
  ASSERT_EQ(inliers.size(), 60U);
  for (std::size_t i = 0; i < inliers.size(); ++i) EXPECT_EQ(inliers[i], i % 3 != 0) << i;
}

TEST(HomographyInliers, AreTheSameEveryTime) {
  const auto matches = matchesUnder(someHomography(), 30, 1.5);
  EXPECT_EQ(homographyInliers(matches, 2.0), homographyInliers(matches, 2.0));
}

TEST(HomographyInliers, AreNotGivenForFourLinesThatAlwaysAgree) {
  EXPECT_TRUE(homographyInliers(matchesUnder(someHomography(), 4, 0.0), 2.0).empty());
}

}  // namespace
}  // namespace tet_line_tracker
