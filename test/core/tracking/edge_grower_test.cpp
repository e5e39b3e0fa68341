#include "tracking/edge_grower.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "bent_edge.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 200);

/// Columns of an image.
struct Columns {
  int begin, end;
};

/// A horizontal edge between rows 99 and 100, brighter above, but for the columns of a gap, which are gray.
cv::Mat edgeWithGap(const Columns& gap = {0, 0}) {
  cv::Mat image(kSize, CV_8UC1, cv::Scalar(60));
  image.rowRange(0, 100).setTo(150);
  image.colRange(gap.begin, gap.end).setTo(105);
  return image;
}

class EdgeGrowerTest : public testing::Test {
 protected:
  EdgeGrowerTest() { area_.setImageSize(kSize); }

  /// A new line fitted to its edge; the brighter side must lie to the left of its direction.
  bool grow(const cv::Mat& image, const LineSegment& line, float margin = 0.0F) {
    fit(image, line);
    return grower_.grow(image, area_, margin, edge_, bend_);
  }

  void fit(const cv::Mat& image, const LineSegment& line) {
    const LineCurve curve = area_.lens().curve(line);
    edge_ = refiner_.fit(image, curve, refiner_.contrastOf(image, curve));
    bend_ = curve.bend;
    ASSERT_GT(edge_.support, 0.9F);
  }

  LineRefiner refiner_{LineRefinerParameters{}};
  EdgeGrower grower_{refiner_};
  VisibleArea area_{2.0};
  EdgeFit edge_;
  LineBend bend_;
};

TEST_F(EdgeGrowerTest, ALineGrowsToBothEndsOfItsEdge) {
  cv::Mat image = edgeWithGap();
  image.colRange(0, 100).setTo(105);
  image.colRange(500, 640).setTo(105);
  ASSERT_TRUE(grow(image, {{280.0F, 99.5F}, {340.0F, 99.5F}}));
  EXPECT_NEAR(edge_.segment.start.x(), 100.0F, 3.0F) << "start stays start";
  EXPECT_NEAR(edge_.segment.end.x(), 500.0F, 3.0F);
  EXPECT_NEAR(edge_.segment.start.y(), 99.5F, 0.05F);
  EXPECT_NEAR(edge_.segment.end.y(), 99.5F, 0.05F);
  // With nothing left to grow to.
  EXPECT_FALSE(grower_.grow(image, area_, 0.0F, edge_, bend_));
}

TEST_F(EdgeGrowerTest, SmallGapsAreBridgedAndLargerOnesAreNot) {
  const LineSegment line{{100.0F, 99.5F}, {300.0F, 99.5F}};
  grow(edgeWithGap({310, 318}), line);  // 4 % of the line
  EXPECT_GT(edge_.segment.end.x(), 400.0F);
  grow(edgeWithGap({310, 340}), line);
  EXPECT_LT(edge_.segment.end.x(), 312.0F);
}

TEST_F(EdgeGrowerTest, ALittleOfAnEdgeBehindAGapDoesNotCount) {
  cv::Mat image = edgeWithGap({310, 318});
  image.colRange(328, 640).setTo(105);  // 10 px of it
  grow(image, {{100.0F, 99.5F}, {300.0F, 99.5F}});
  EXPECT_LT(edge_.segment.end.x(), 312.0F);
}

TEST_F(EdgeGrowerTest, ALineDoesNotGrowAlongAnEdgeOfTheOtherPolarityOrBesideItsOwn) {
  cv::Mat image = edgeWithGap();
  image(cv::Rect(300, 0, 340, 100)).setTo(60);
  image(cv::Rect(300, 100, 340, 100)).setTo(150);
  grow(image, {{150.0F, 99.5F}, {250.0F, 99.5F}});
  EXPECT_LT(edge_.segment.end.x(), 302.0F);
  image = edgeWithGap();
  image(cv::Rect(300, 100, 340, 2)).setTo(150);  // a step of 2 px
  grow(image, {{150.0F, 99.5F}, {250.0F, 99.5F}});
  EXPECT_LT(edge_.segment.end.x(), 302.0F);
}

TEST_F(EdgeGrowerTest, NothingGrowsFromALineThatHardlyLiesOnAnEdge) {
  const cv::Mat image = edgeWithGap();
  fit(image, {{280.0F, 99.5F}, {340.0F, 99.5F}});
  edge_.support = 0.7F;
  EXPECT_FALSE(grower_.grow(image, area_, 0.0F, edge_, bend_));
}

TEST_F(EdgeGrowerTest, GrowthEndsAtTheMarginAndAtTheMask) {
  const cv::Mat image = edgeWithGap();
  ASSERT_TRUE(grow(image, {{60.0F, 99.5F}, {160.0F, 99.5F}}, 3.0F));
  EXPECT_FLOAT_EQ(edge_.segment.start.x(), 5.0F) << "2 px of border, 3 px of margin";
  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
  mask.colRange(0, 50).setTo(0);
  area_.setMask(mask);
  area_.setImageSize(kSize);
  grow(image, {{60.0F, 99.5F}, {160.0F, 99.5F}});
  EXPECT_FLOAT_EQ(edge_.segment.start.x(), 60.0F);
}

TEST_F(EdgeGrowerTest, ThroughALensALineGrowsAlongTheCurve) {
  const std::shared_ptr<const CameraModel> camera = eurocCamera();
  area_.setCamera(camera);
  area_.setImageSize({752, 480});
  // Above the centre, where the lens bends lines by many pixels; brighter above.
  const BentEdge edge(camera, {{100.0F, 60.0F}, {650.0F, 50.0F}});
  const cv::Mat image = edge.image(90.0F, 1.0F);
  const LineCurve whole = area_.lens().curve({{100.0F, 60.0F}, {650.0F, 50.0F}});
  ASSERT_GT(std::abs(whole.bend.offset(0.5F)), 5.0F);
  ASSERT_TRUE(grow(image, {whole.at(0.45F), whole.at(0.55F)}));
  EXPECT_GT(edge_.segment.length(), 400.0F);
  EXPECT_LT(std::abs(edge.distance(edge_.segment.start)), 0.15);
  EXPECT_LT(std::abs(edge.distance(edge_.segment.end)), 0.15);
  const LineCurve grown(edge_.segment, bend_);
  for (const float share : {0.25F, 0.5F, 0.75F}) EXPECT_LT(std::abs(edge.distance(grown.at(share))), 0.1);
}

TEST_F(EdgeGrowerTest, ATrackedLineGrowsWhereItWasCutAndInEveryFourthImageAtBothEnds) {
  const cv::Mat image = edgeWithGap();
  const LineSegment segment{{200.0F, 99.5F}, {300.0F, 99.5F}};
  TrackedLine line;
  line.id = 6;
  int both = 0;
  for (std::uint64_t number = 1; number <= 8; ++number) {
    line.cut = 0;
    fit(image, segment);
    const bool due = grower_.growTracked(image, area_, number, line, edge_, bend_);
    both += due ? 1 : 0;
    EXPECT_EQ(edge_.segment.start.x() < 190.0F, due);
    EXPECT_EQ(edge_.segment.end.x() > 310.0F, due);
    if (due) continue;
    line.cut = kEndCut;
    fit(image, segment);
    EXPECT_TRUE(grower_.growTracked(image, area_, number, line, edge_, bend_));
    EXPECT_FLOAT_EQ(edge_.segment.start.x(), 200.0F);
    EXPECT_GT(edge_.segment.end.x(), 310.0F);
  }
  EXPECT_EQ(both, 2);
}

}  // namespace
}  // namespace tet_line_tracker
