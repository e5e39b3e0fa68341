#include "tracking/track_initializer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/segment_index.h"
#include "rectangle_images.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 480);

class TrackInitializerTest : public testing::Test {
 protected:
  TrackInitializerTest() { area_.setImageSize(kSize); }

  void addTracks(const cv::Mat& image) {
    TrackInitializer initializer(parameters_, LineRefiner(LineRefinerParameters{}), options_);
    initializer.addTracks(image, area_, tracks_, statistics_);
  }

  std::size_t countRightOf(float x) const {
    return static_cast<std::size_t>(
        std::count_if(tracks_.lines().begin(), tracks_.lines().end(),
                      [x](const TrackedLine& line) { return line.segment.middle().x() > x; }));
  }

  DetectionParameters parameters_;
  TrackInitializer::Options options_;
  VisibleArea area_{2.0};
  TrackTable tracks_;
  FrameStatistics statistics_;
};

TEST_F(TrackInitializerTest, StartsATrackOnEachSideOfASquare) {
  addTracks(rectanglesImage(kSize, {squareAt(200.3F, 200.7F, 100.0F, 200.0F)}));
  ASSERT_EQ(tracks_.size(), 4U);
  EXPECT_EQ(statistics_.lines_added, 4U);
  EXPECT_GE(statistics_.lines_detected, 4U);
  for (const TrackedLine& line : tracks_.lines()) {
    EXPECT_NEAR(line.segment.distance({200.3F, 200.7F}), 50.0F, 0.1F) << "bright inside, on the left";
  }
}

TEST_F(TrackInitializerTest, StartsNoTrackOnAnEdgeThatIsTrackedAlready) {
  const cv::Mat image = rectanglesImage(kSize, {squareAt(200.3F, 200.7F, 100.0F, 200.0F)});
  addTracks(image);
  addTracks(image);
  EXPECT_EQ(tracks_.size(), 4U);
  EXPECT_EQ(statistics_.lines_added, 0U);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(areDuplicates(tracks_.line(i).segment, tracks_.line(k).segment, DuplicateCriteria{}));
    }
  }
}

TEST_F(TrackInitializerTest, SpreadsNewTracksOverTheImage) {
  // 28 long lines crowd on the left; eight shorter ones lie on the right.
  std::vector<Rectangle> rectangles{squareAt(560.0F, 100.0F, 60.0F, 200.0F),
                                    squareAt(560.0F, 400.0F, 60.0F, 200.0F)};
  for (int i = 0; i < 14; ++i) {
    const float y = 30.0F + 30.0F * static_cast<float>(i);
    rectangles.push_back({20.0F, y, 150.0F, y + 15.0F, 200.0F});
  }
  parameters_.max_lines = 24;
  const cv::Mat image = rectanglesImage(kSize, rectangles);
  addTracks(image);
  EXPECT_EQ(tracks_.size(), 24U);
  EXPECT_GE(countRightOf(400.0F), 6U);
  // As in the paper, the longest ones alone.
  options_.spread = false;
  tracks_.clear();
  addTracks(image);
  EXPECT_EQ(tracks_.size(), 24U);
  EXPECT_EQ(countRightOf(400.0F), 0U);
}

TEST_F(TrackInitializerTest, StartsNewTracksFarFromThoseThereAre) {
  std::vector<Rectangle> rectangles;
  for (const float x : {100.0F, 540.0F}) {
    for (const float y : {100.0F, 240.0F, 380.0F}) rectangles.push_back(squareAt(x, y, 60.0F, 200.0F));
  }
  // The tracks of a crowd on the left, beside the edges there.
  for (int i = 0; i < 12; ++i) {
    const float y = 20.0F + 38.0F * static_cast<float>(i);
    EdgeFit edge;
    edge.segment = {{10.0F, y}, {200.0F, y + 10.0F}};
    edge.contrast = 20.0F;
    tracks_.add(edge, LineBend{});
  }
  parameters_.max_lines = 24;
  addTracks(rectanglesImage(kSize, rectangles));
  EXPECT_EQ(tracks_.size(), 24U);
  EXPECT_EQ(countRightOf(400.0F), 12U);
}

TEST_F(TrackInitializerTest, NeverHoldsMoreThanMaxLines) {
  std::vector<Rectangle> rectangles;
  for (int i = 0; i < 6; ++i)
    rectangles.push_back(squareAt(60.0F + 100.0F * static_cast<float>(i), 200.0F, 60.0F, 200.0F));
  parameters_.max_lines = 10;
  addTracks(rectanglesImage(kSize, rectangles));
  EXPECT_EQ(tracks_.size(), 10U);
}

TEST_F(TrackInitializerTest, NewLinesAreALittleLongerAndFartherInsideThanTheyMustBe) {
  parameters_.min_length = 60.0;
  parameters_.border = 2.0;
  // Its long sides leave the image on the left.
  const cv::Mat image = rectanglesImage(kSize, {{-50.0F, 100.0F, 150.0F, 163.0F, 200.0F}});
  addTracks(image);
  ASSERT_EQ(tracks_.size(), 2U) << "the short side is found 61 px long";
  for (const TrackedLine& line : tracks_.lines()) {
    EXPECT_FLOAT_EQ(std::min(line.segment.start.x(), line.segment.end.x()), 4.0F);
  }
}

TEST_F(TrackInitializerTest, ALineWithoutAnEdgeUnderMinDetectionSupportOfItIsLeftOut) {
  // A side with gaps, which a detector bridges: an edge lies under a part of it only.
  cv::Mat image = rectanglesImage(kSize, {{100.0F, 100.0F, 400.0F, 300.0F, 130.0F}});
  parameters_.min_detection_support = 1.0;
  cv::RNG random(3);
  cv::Mat noise(kSize, CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 6.0);
  cv::add(image, noise, image, cv::noArray(), CV_8U);
  addTracks(image);
  const std::size_t strict = tracks_.size();
  tracks_.clear();
  parameters_.min_detection_support = 0.0;
  addTracks(image);
  EXPECT_LT(strict, tracks_.size());
}

/// A horizontal edge over the whole width, with gaps of `gap` px where the gray is that of the dark side.
cv::Mat brokenEdge(float bright, int period, int gap) {
  std::vector<Rectangle> rectangles;
  for (int x = 0; x < kSize.width; x += period) {
    rectangles.push_back(
        {static_cast<float>(x + gap), 100.0F, static_cast<float>(x + period), 300.0F, bright});
  }
  return rectanglesImage(kSize, rectangles);
}

TEST_F(TrackInitializerTest, PiecesOfOneEdgeAreOneTrackOverAGapThatTheDetectorDoesNotJump) {
  // Pieces of 308 px; the upper and the lower edge of both.
  const cv::Mat image = brokenEdge(200.0F, 320, 12);
  options_.grow = false;
  addTracks(image);
  const auto isLevel = [](const TrackedLine& line) {
    return std::abs(line.segment.end.y() - line.segment.start.y()) < 1.0F;
  };
  EXPECT_EQ(std::count_if(tracks_.lines().begin(), tracks_.lines().end(), isLevel), 4);
  tracks_.clear();
  options_.grow = true;
  addTracks(image);
  EXPECT_EQ(std::count_if(tracks_.lines().begin(), tracks_.lines().end(), isLevel), 2);
  for (const TrackedLine& line : tracks_.lines()) {
    if (!isLevel(line)) continue;
    EXPECT_GT(line.segment.length(), 600.0F);
  }
}

TEST_F(TrackInitializerTest, AClearEdgeMayHaveAQuarterOfTheGapsOfAFaintOne) {
  // Gaps over 11 %.
  const auto count = [this](float bright) {
    tracks_.clear();
    addTracks(brokenEdge(bright, 36, 4));
    return std::count_if(tracks_.lines().begin(), tracks_.lines().end(),
                         [](const TrackedLine& line) { return line.segment.length() > 300.0F; });
  };
  EXPECT_EQ(count(140.0F), 2);
  EXPECT_EQ(count(240.0F), 0);
  parameters_.min_detection_support = 0.5;
  EXPECT_EQ(count(240.0F), 2);
}

}  // namespace
}  // namespace tet_line_tracker
