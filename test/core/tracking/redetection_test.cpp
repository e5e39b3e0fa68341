// When LineTracker detects again: the rules of detection_policy_test on images.
#include <functional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "rectangle_images.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 480);  // the coverage is counted in cells of 80 x 80 px

using Scene = std::function<std::vector<Rectangle>(int image)>;

/// The images, counted from zero, in which the detector ran.
std::set<int> detections(const DetectionParameters& detection, int images, const Scene& scene) {
  LineTrackerParameters parameters;
  parameters.detection = detection;
  LineTracker tracker(parameters);
  std::set<int> detected;
  for (int k = 0; k < images; ++k) {
    const cv::Mat image = rectanglesImage(kSize, scene(k));
    if (tracker.process(image, 1000000000 + 50000000 * static_cast<std::int64_t>(k)).frame->detected) {
      detected.insert(k);
    }
  }
  return detected;
}

DetectionParameters parameters() {
  DetectionParameters parameters;
  parameters.min_lines = 4;
  parameters.detection_interval = 3;
  return parameters;
}

/// Three squares, one in the other, whose lines share cells, `count` times.
std::vector<Rectangle> nested(int count) {
  std::vector<Rectangle> rectangles;
  for (int i = 0; i < count; ++i) {
    const float x = 120.0F + 160.0F * static_cast<float>(i);
    rectangles.push_back(squareAt(x, 200.0F, 150.0F, 220.0F));
    rectangles.push_back(squareAt(x, 200.0F, 120.0F, 60.0F));
    rectangles.push_back(squareAt(x, 200.0F, 90.0F, 220.0F));
  }
  return rectangles;
}

TEST(Redetection, DetectsOnceWhileNothingIsLost) {
  EXPECT_EQ(detections(parameters(), 8, [](int) { return nested(2); }), (std::set<int>{0}));
}

TEST(Redetection, DetectsAgainWhenTheNumberOfLinesFallsWithTheCoverageAsItWas) {
  const Scene scene = [](int image) {
    std::vector<Rectangle> rectangles = nested(2);
    if (image >= 5) rectangles.pop_back();  // 4 of 24 lines, whose cells others cross
    return rectangles;
  };
  EXPECT_EQ(detections(parameters(), 10, scene), (std::set<int>{0, 5}));
  DetectionParameters never = parameters();
  never.redetect_ratio = 0.0;
  EXPECT_EQ(detections(never, 10, scene), (std::set<int>{0}));
}

TEST(Redetection, DetectsAgainWhenTheCoverageFallsWithNearlyAllLinesThere) {
  const Scene scene = [](int image) {
    std::vector<Rectangle> rectangles = nested(3);                                 // 36 lines
    if (image < 5) rectangles.push_back({10.0F, 420.0F, 630.0F, 450.0F, 220.0F});  // 2 lines, 8 cells
    return rectangles;
  };
  EXPECT_EQ(detections(parameters(), 10, scene), (std::set<int>{0, 5}));
}

TEST(Redetection, DetectsAgainWhenFewerThanMinLinesAreLeftEveryDetectionIntervalImages) {
  DetectionParameters many = parameters();
  many.min_lines = 30;
  EXPECT_EQ(detections(many, 9, [](int) { return nested(2); }), (std::set<int>{0, 3, 6}));
  many.detection_interval = 4;
  EXPECT_EQ(detections(many, 9, [](int) { return nested(2); }), (std::set<int>{0, 4, 8}));
}

TEST(Redetection, WaitsDetectionIntervalImagesAlsoWhenLinesAreLostAtOnce) {
  const Scene scene = [](int image) {
    std::vector<Rectangle> rectangles = nested(3);
    if (image >= 5) rectangles.resize(6);
    if (image >= 6) rectangles.resize(3);
    return rectangles;
  };
  EXPECT_EQ(detections(parameters(), 12, scene), (std::set<int>{0, 5, 8}));
}

TEST(Redetection, DetectsOnTheFirstImageAfterAReset) {
  LineTrackerParameters parameters;
  LineTracker tracker(parameters);
  const cv::Mat image = rectanglesImage(kSize, nested(3));
  EXPECT_TRUE(tracker.process(image, 1000000000).frame->detected);
  EXPECT_FALSE(tracker.process(image, 1050000000).frame->detected);
  tracker.reset();
  EXPECT_TRUE(tracker.process(image, 1100000000).frame->detected);
}

}  // namespace
}  // namespace tet_line_tracker
