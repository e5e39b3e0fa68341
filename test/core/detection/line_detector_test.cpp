#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edge_images.h"
#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {
namespace {

bool sameLines(const std::vector<LineSegment>& a, const std::vector<LineSegment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const LineSegment& u, const LineSegment& v) {
    return u.start == v.start && u.end == v.end;
  });
}

class EveryDetector : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<LineDetector> detector_{makeLineDetector(GetParam())};
  std::vector<LineSegment> lines_;
};

INSTANTIATE_TEST_SUITE_P(LineDetector, EveryDetector, testing::ValuesIn(availableDetectors()),
                         [](const auto& info) { return info.param; });

TEST_P(EveryDetector, IsMadeByItsName) {
  EXPECT_EQ(detector_->name(), GetParam());
}

TEST_P(EveryDetector, FindsTheFourSidesOfASquareWithTheBrighterSideToTheLeft) {
  for (const bool bright_square : {true, false}) {
    cv::Mat image(160, 200, CV_8UC1, cv::Scalar(bright_square ? 50 : 200));
    // Gray changes half-way between two pixel centres: the sides lie at 59.5, 139.5 and 39.5, 119.5.
    image(cv::Rect(60, 40, 80, 80)).setTo(bright_square ? 200 : 50);
    detector_->detect(image, 50.0F, lines_);
    ASSERT_EQ(lines_.size(), 4U);
    const Eigen::Vector2f centre(99.5F, 79.5F);
    int sides = 0;
    for (const LineSegment& line : lines_) {
      EXPECT_NEAR(std::abs(line.distance(centre)), 40.0F, 0.6F);
      EXPECT_EQ(line.distance(centre) > 0.0F, bright_square);
      const Eigen::Vector2f out = line.middle() - centre;
      sides |= std::abs(out.x()) > std::abs(out.y()) ? (out.x() > 0 ? 1 : 2) : (out.y() > 0 ? 4 : 8);
    }
    EXPECT_EQ(sides, 15);
  }
}

TEST_P(EveryDetector, HasNoConstantBiasOnAntiAliasedEdges) {
  // FLD gives whole pixels; the mean over positions shows a wrong convention all the same.
  double sum_x = 0.0;
  double sum_y = 0.0;
  int count = 0;
  for (int i = 0; i < 20; ++i) {
    const double angle = 2.0 * CV_PI * i / 20.0 + 0.05;
    detector_->detect(halfPlane({160, 120}, angle, 0.1 * i - 1.0), 60.0F, lines_);
    if (lines_.empty()) continue;
    const LineSegment& line = lines_.front();
    const Eigen::Vector2f n(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    EXPECT_GT(line.normal().dot(n), 0.99F) << "angle " << angle;
    const double error = n.dot(line.middle() - Eigen::Vector2f(79.5F, 59.5F)) - (0.1 * i - 1.0);
    EXPECT_LT(std::abs(error), 0.75) << "angle " << angle;
    sum_x += error * n.x();
    sum_y += error * n.y();
    ++count;
  }
  ASSERT_GE(count, 18);
  EXPECT_LT(std::abs(sum_x / count), 0.05);
  EXPECT_LT(std::abs(sum_y / count), 0.05);
}

TEST_P(EveryDetector, GivesOnlyLinesInsideTheImageOfAtLeastTheMinimumLengthLongestFirst) {
  const cv::Mat image = halfPlane({161, 121}, 0.7, 3.0);
  for (const float min_length : {10.0F, 40.0F, 1000.0F}) {
    detector_->detect(image, min_length, lines_);
    for (const LineSegment& line : lines_) {
      EXPECT_GE(line.length(), min_length);
      for (const Eigen::Vector2f& p : {line.start, line.end}) {
        EXPECT_TRUE(ImageBounds::ofImage(image.cols, image.rows).contains(p)) << p.transpose();
      }
    }
    EXPECT_TRUE(std::is_sorted(lines_.begin(), lines_.end(), [](const auto& a, const auto& b) {
      return (a.end - a.start).squaredNorm() > (b.end - b.start).squaredNorm();
    }));
    EXPECT_EQ(lines_.empty(), min_length > 500.0F);
  }
}

TEST_P(EveryDetector, TakesImagesOfAnySizeAndStride) {
  const cv::Mat large = withNoise(halfPlane({640, 480}, 0.5, 0.0), 8.0, 3);
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(1, 40), cv::Size(40, 1), cv::Size(2, 2), cv::Size(3, 5), cv::Size(7, 9),
        cv::Size(16, 16), cv::Size(17, 31), cv::Size(33, 250), cv::Size(640, 480)}) {
    const cv::Mat view = large(cv::Rect(0, 0, size.width, size.height));
    detector_->detect(view, 10.0F, lines_);
    const std::vector<LineSegment> of_view = lines_;
    detector_->detect(view.clone(), 10.0F, lines_);
    EXPECT_TRUE(sameLines(of_view, lines_)) << size;
  }
  detector_->detect(cv::Mat(), 10.0F, lines_);
  EXPECT_TRUE(lines_.empty());
}

TEST_P(EveryDetector, FindsNothingInAConstantImage) {
  for (const int gray : {0, 128, 255}) {
    detector_->detect(cv::Mat(120, 160, CV_8UC1, cv::Scalar(gray)), 10.0F, lines_);
    EXPECT_TRUE(lines_.empty());
  }
}

TEST_P(EveryDetector, GivesTheSameLinesAgainAlsoAfterAnotherImage) {
  const cv::Mat image = withNoise(halfPlane({320, 240}, 0.3, 5.0), 4.0, 1);
  detector_->detect(image, 20.0F, lines_);
  const std::vector<LineSegment> first = lines_;
  ASSERT_FALSE(first.empty());
  detector_->detect(noiseImage({640, 480}, 128.0, 20.0, 2), 20.0F, lines_);
  detector_->detect(image, 20.0F, lines_);
  EXPECT_TRUE(sameLines(first, lines_));
  makeLineDetector(GetParam())->detect(image, 20.0F, lines_);
  EXPECT_TRUE(sameLines(first, lines_));
}

TEST_P(EveryDetector, GivesOnlyLinesWhereTheMaskIsWhite) {
  cv::Mat image(160, 320, CV_8UC1, cv::Scalar(50));
  image(cv::Rect(40, 40, 80, 80)).setTo(200);
  image(cv::Rect(200, 40, 80, 80)).setTo(200);
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(255));
  mask.colRange(0, 160).setTo(0);
  detector_->detect(image, 40.0F, lines_, {mask, {}});
  EXPECT_EQ(lines_.size(), 4U);
  for (const LineSegment& line : lines_) EXPECT_GT(line.middle().x(), 160.0F);
}

TEST_P(EveryDetector, RefusesOtherTypesAndMasksOfAnotherSize) {
  EXPECT_THROW(detector_->detect(cv::Mat(50, 50, CV_8UC3), 10.0F, lines_), std::invalid_argument);
  EXPECT_THROW(detector_->detect(cv::Mat(50, 50, CV_16UC1), 10.0F, lines_), std::invalid_argument);
  EXPECT_THROW(detector_->detect(cv::Mat(50, 50, CV_8UC1), 10.0F, lines_, {cv::Mat(50, 51, CV_8UC1), {}}),
               std::invalid_argument);
}

TEST(LineDetectorFactory, TakesTheFirstAvailableDetectorForAuto) {
  ASSERT_FALSE(availableDetectors().empty());
  EXPECT_EQ(makeLineDetector("auto")->name(), availableDetectors().front());
}

TEST(LineDetectorFactory, NamesTheDetectorTheVersionAndTheChoicesWhenThereIsNoSuchDetector) {
  try {
    makeLineDetector("hough");
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("hough"), std::string::npos);
    EXPECT_NE(message.find(CV_VERSION), std::string::npos);
    EXPECT_NE(message.find(availableDetectors().front()), std::string::npos);
  }
}

}  // namespace
}  // namespace tet_line_tracker
