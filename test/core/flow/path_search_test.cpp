// The search for a line along the way that its depth leaves open.
#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "synthetic_images.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr float kStep = 6.0F;
const LineSegment kEdge{{60.3F, 45.0F}, {60.3F, 125.0F}};  // left side of a box

ImagePyramid pyramidOf(const cv::Mat& image) {
  ImagePyramid pyramid;
  pyramid.build(image, 3);
  return pyramid;
}

LineSegment moved(const LineSegment& line, float x) {
  return {line.start + Eigen::Vector2f(x, 0.0F), line.end + Eigen::Vector2f(x, 0.0F)};
}

/// To the right, in steps of kStep.
LinePath pathOf(const LineSegment& line, std::size_t count, std::size_t expected) {
  LinePath path;
  path.count = count;
  path.expected = expected;
  for (std::size_t k = 0; k < count; ++k) path.chords[k] = moved(line, kStep * static_cast<float>(k));
  return path;
}

class PathSearch : public testing::Test {
 protected:
  /// Places of the line of `first` on `path` in `second`.
  std::size_t search(const cv::Mat& first, const LineSegment& line, const cv::Mat& second,
                     const LinePath& path) {
    flow_->extractTemplate(pyramidOf(first), line, patches_);
    return flow_->search(patches_, pyramidOf(second), path, best_);
  }

  std::unique_ptr<EndpointTracker> flow_ = makeJointFlow({});
  LineTemplate patches_;
  std::array<LineSegment, EndpointTracker::kMaxStarts> best_;
};

TEST_F(PathSearch, FindsALineFarFromWhereItWasExpected) {
  for (const float shift : {0.0F, 31.0F, 95.0F, 170.0F}) {
    ASSERT_GE(search(boxesImage(kWidth, kHeight, {0, 0}), kEdge, boxesImage(kWidth, kHeight, {shift, 0}),
                     pathOf(kEdge, 31, 5)),
              1U);
    EXPECT_NEAR(best_[0].start.x(), kEdge.start.x() + shift, kStep) << shift;
    EXPECT_NEAR(best_[0].end.x(), kEdge.end.x() + shift, kStep) << shift;
  }
}

TEST_F(PathSearch, FindsALineWhoseEndsAreAtDifferentDepths) {
  // The near end moves three times as far.
  const LineSegment before{{100, 100}, {100, 260}};
  const LineSegment after{{130, 100}, {190, 260}};
  const auto draw = [](const LineSegment& line) {
    cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(80));
    const std::array<cv::Point, 4> outline = {cv::Point(cvRound(line.start.x()), cvRound(line.start.y())),
                                              cv::Point(600, 100), cv::Point(600, 260),
                                              cv::Point(cvRound(line.end.x()), cvRound(line.end.y()))};
    cv::fillConvexPoly(image, outline.data(), 4, cv::Scalar(200), cv::LINE_AA);
    return image;
  };
  ASSERT_GE(search(draw(before), before, draw(after), pathOf(before, 21, 3)), 1U);
  EXPECT_NEAR(best_[0].start.x(), after.start.x(), 2.0F * kStep);
  EXPECT_NEAR(best_[0].end.x(), after.end.x(), 2.0F * kStep);
}

TEST_F(PathSearch, TakesTheExpectedOneOfAlikeLines) {
  // Bars every 48 px: each looks like the next.
  cv::Mat bars(kHeight, kWidth, CV_8UC1, cv::Scalar(60));
  for (int x = 48; x < kWidth; x += 48) cv::rectangle(bars, {x, 0, 24, kHeight}, cv::Scalar(200), -1);
  const LineSegment bar{{95.5F, 100.0F}, {95.5F, 200.0F}};
  for (const std::size_t expected : {0U, 8U, 16U}) {
    ASSERT_GE(search(bars, bar, bars, pathOf(bar, 25, expected)), 2U);
    EXPECT_NEAR(best_[0].middle().x(), bar.start.x() + kStep * static_cast<float>(expected), kStep);
  }
}

TEST_F(PathSearch, GivesPlacesThatAreApart) {
  const std::size_t count = search(boxesImage(kWidth, kHeight, {0, 0}), kEdge,
                                   boxesImage(kWidth, kHeight, {40, 0}), pathOf(kEdge, 31, 0));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(std::max((best_[i].start - best_[j].start).norm(), (best_[i].end - best_[j].end).norm()),
                1.9F * kStep);
    }
  }
}

TEST_F(PathSearch, FindsNothingByATemplateWithoutContrast) {
  const cv::Mat flat(kHeight, kWidth, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(search(flat, kEdge, boxesImage(kWidth, kHeight, {0, 0}), pathOf(kEdge, 31, 0)), 0U);
}

}  // namespace
}  // namespace tet_line_tracker
