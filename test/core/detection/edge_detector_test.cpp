#include "detection/edge_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "bent_edge.h"
#include "edge_images.h"
#include "geometry/segment_index.h"
#include "kernels/kernels.h"

namespace {

long allocations = 0;

}  // namespace

// Counts what the standard containers take from the heap. Not inlined, or GCC takes new and free for a
// mismatch.
__attribute__((noinline)) void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* memory) noexcept {
  std::free(memory);
}
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tet_line_tracker {
namespace {

std::vector<LineSegment> linesOf(LineDetector& detector, const cv::Mat& image, float min_length) {
  std::vector<LineSegment> lines;
  detector.detect(image, min_length, lines);
  return lines;
}

/// A picture with many edges: overlapping rectangles of random place, turn and gray, slightly blurred.
cv::Mat rectangles(cv::Size size, unsigned seed) {
  cv::Mat image(size, CV_8UC1, cv::Scalar(110));
  std::mt19937 random(seed);
  const auto uniform = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  for (int i = 0; i < 25; ++i) {
    const cv::RotatedRect box(
        {uniform(0.0F, static_cast<float>(size.width)), uniform(0.0F, static_cast<float>(size.height))},
        {uniform(30.0F, 200.0F), uniform(30.0F, 200.0F)}, uniform(0.0F, 180.0F));
    cv::Point2f corners[4];
    box.points(corners);
    const std::vector<cv::Point> polygon(corners, corners + 4);
    cv::fillConvexPoly(image, polygon, cv::Scalar(uniform(20.0F, 235.0F)), cv::LINE_AA);
  }
  cv::GaussianBlur(image, image, cv::Size(), 0.7);
  return image;
}

TEST(EdgeDetector, FindsTrackedLinesNotAgain) {
  const cv::Mat image = rectangles({640, 480}, 4);
  EdgeDetector detector;
  DetectionHints hints;
  const std::vector<LineSegment> all = linesOf(detector, image, 30.0F);
  ASSERT_GE(all.size(), 20U);
  for (std::size_t i = 0; i < all.size(); i += 2) hints.tracked.push_back(all[i]);
  std::vector<LineSegment> rest;
  detector.detect(image, 30.0F, rest, hints);
  SegmentIndex tracked({0.05F, 1.0F, 0.5F});
  SegmentIndex found({0.05F, 1.0F, 0.5F});
  for (const LineCurve& line : hints.tracked) tracked.add(line);
  for (const LineSegment& line : rest) {
    EXPECT_FALSE(tracked.containsDuplicateOf(line));
    found.add(line);
  }
  // The others are all there, as they were or in two pieces where a tracked line crosses them.
  for (std::size_t i = 1; i < all.size(); i += 2) {
    EXPECT_TRUE(found.containsDuplicateOf(all[i])) << i;
  }
}

TEST(EdgeDetector, PlacesEdgesOfAnyDirectionWithinATenthOfAPixel) {
  EdgeDetector detector;
  for (int i = 0; i < 72; ++i) {
    const double angle = CV_PI * i / 36.0;
    const double offset = 0.13 * i - 4.0;
    const std::vector<LineSegment> lines =
        linesOf(detector, withNoise(halfPlane({160, 120}, angle, offset), 1.0, 5), 60.0F);
    ASSERT_EQ(lines.size(), 1U) << "angle " << angle;
    const Eigen::Vector2f n(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    for (const Eigen::Vector2f& p : {lines[0].start, lines[0].end}) {
      EXPECT_NEAR(n.dot(p - Eigen::Vector2f(79.5F, 59.5F)), offset, 0.1) << "angle " << angle;
    }
    EXPECT_GT(lines[0].normal().dot(n), 0.999F);
  }
}

TEST(EdgeDetector, FindsEdgesOfTenGrayLevelsUnderNoiseOfOneAtAnyBrightness) {
  EdgeDetector detector;
  for (const int dark : {10, 60, 120, 220}) {
    cv::Mat image(200, 240, CV_8UC1, cv::Scalar(dark));
    image(cv::Rect(60, 50, 120, 100)).setTo(dark + 10);
    const std::vector<LineSegment> lines = linesOf(detector, withNoise(image, 1.0, 7), 60.0F);
    EXPECT_EQ(lines.size(), 4U) << "dark " << dark;
  }
}

TEST(EdgeDetector, FindsAlmostNothingInNoise) {
  EdgeDetector detector;
  std::size_t lines = 0;
  for (const double sigma : {0.3, 1.0, 3.0, 10.0, 30.0, 80.0}) {
    for (const double mean : {3.0, 128.0}) {
      cv::Mat noise = noiseImage({752, 480}, mean, sigma, 11);
      lines += linesOf(detector, noise, 20.0F).size();
      cv::GaussianBlur(noise, noise, cv::Size(3, 3), 0.8);
      lines += linesOf(detector, noise, 30.0F).size();
    }
  }
  EXPECT_LE(lines, 2U);
}

TEST(EdgeDetector, FindsMostLinesAlsoInATenthOfTheLight) {
  EdgeDetector detector;
  const cv::Mat image = rectangles({752, 480}, 3);
  const std::size_t lit = linesOf(detector, withNoise(image, 1.0, 1), 30.0F).size();
  cv::Mat dim;
  image.convertTo(dim, CV_8U, 0.1);
  const std::size_t unlit = linesOf(detector, withNoise(dim, 1.0, 2), 30.0F).size();
  EXPECT_GE(lit, 40U);
  EXPECT_GE(unlit, 6 * lit / 10);
}

TEST(EdgeDetector, FindsAgainWhatWasThereBeforeATurnMoreOftenThanNot) {
  EdgeDetector detector;
  const cv::Mat image = rectangles({752, 480}, 4);
  cv::Mat motion = cv::getRotationMatrix2D({376.0F, 240.0F}, 3.3, 1.02);
  motion.at<double>(0, 2) += 4.4;
  cv::Mat moved;
  cv::warpAffine(image, moved, motion, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  const std::vector<LineSegment> before = linesOf(detector, withNoise(image, 2.0, 1), 30.0F);
  const std::vector<LineSegment> after = linesOf(detector, withNoise(moved, 2.0, 2), 20.0F);
  const auto move = [&motion](const Eigen::Vector2f& p) {
    const cv::Mat_<double> m = motion;
    return Eigen::Vector2f(static_cast<float>(m(0, 0) * p.x() + m(0, 1) * p.y() + m(0, 2)),
                           static_cast<float>(m(1, 0) * p.x() + m(1, 1) * p.y() + m(1, 2)));
  };
  int there = 0;
  int found = 0;
  for (const LineSegment& line : before) {
    const auto expected = clip({move(line.start), move(line.end)}, ImageBounds::ofImage(752, 480, 6.0F));
    if (!expected || expected->length() < 30.0F) continue;
    ++there;
    found += std::any_of(after.begin(), after.end(), [&expected](const LineSegment& other) {
      return angleBetween(other, *expected) < 0.05F && overlap(other, *expected) > 0.5F &&
             std::abs(expected->distance(other.start)) < 2.0F &&
             std::abs(expected->distance(other.end)) < 2.0F;
    });
  }
  ASSERT_GE(there, 30);
  EXPECT_GE(found, 9 * there / 10) << found << " of " << there;
}

TEST(EdgeDetector, GoesOnAfterAShortGapAndNotAfterALongOne) {
  EdgeDetector detector;
  for (const int gap : {5, 40}) {
    cv::Mat image(120, 300, CV_8UC1, cv::Scalar(60));
    image.rowRange(60, 120).setTo(160);
    image(cv::Rect(150, 0, gap, 120)).setTo(110);
    const std::vector<LineSegment> lines = linesOf(detector, image, 100.0F);
    const auto level = std::count_if(lines.begin(), lines.end(), [](const LineSegment& line) {
      return std::abs(line.direction().y()) < 0.1F;
    });
    EXPECT_EQ(level, gap == 5 ? 1 : 2);
  }
}

TEST(EdgeDetector, TakesNothingFromTheHeapOnceItHasSeenTheSize) {
  EdgeDetector detector;
  const cv::Mat first = withNoise(rectangles({752, 480}, 5), 2.0, 1);
  const cv::Mat second = first.clone();
  std::vector<LineSegment> lines;
  detector.detect(first, 30.0F, lines);
  ASSERT_FALSE(lines.empty());
  const long before = allocations;
  detector.detect(second, 30.0F, lines);
  EXPECT_EQ(allocations, before);
}

TEST(EdgeDetector, GivesTheSameGradientAndPeaksWithEveryKernelTable) {
  const int width = 333;
  const cv::Mat image = noiseImage({width, 7}, 128.0, 60.0, 9);
  struct Rows {
    std::vector<kernels::Gradient> gradient = std::vector<kernels::Gradient>(3 * 333, {0, 0});
    std::vector<std::int16_t> magnitude = std::vector<std::int16_t>(3 * 333, 0);
    std::vector<std::uint8_t> peaks = std::vector<std::uint8_t>(333, 0);
  };
  const auto rowsWith = [&image](const kernels::KernelTable& table) {
    Rows rows;
    std::vector<std::int16_t> smooth(333), slope(333);
    for (int y = 0; y < 3; ++y) {
      const std::uint8_t* const input[5] = {image.ptr(y), image.ptr(y + 1), image.ptr(y + 2),
                                            image.ptr(y + 3), image.ptr(y + 4)};
      table.gradientRow(input, width, smooth.data(), slope.data(),
                        &rows.gradient[333U * static_cast<unsigned>(y)],
                        &rows.magnitude[333U * static_cast<unsigned>(y)]);
    }
    table.findPeaks(&rows.magnitude[333], 333, &rows.gradient[333], width, 500, rows.peaks.data());
    return rows;
  };
  int count = 0;
  const kernels::KernelTable* const* tables = kernels::available(&count);
  const Rows expected = rowsWith(*tables[0]);

  // The values themselves, by definition.
  const int smooth[5] = {1, 4, 6, 4, 1};
  const int slope[5] = {-1, -2, 0, 2, 1};
  int peaks = 0;
  for (int x = 2; x < width - 2; ++x) {
    int dx = 0;
    int dy = 0;
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 5; ++i) {
        dx += smooth[j] * slope[i] * image.at<uchar>(1 + j, x - 2 + i);
        dy += slope[j] * smooth[i] * image.at<uchar>(1 + j, x - 2 + i);
      }
    }
    const auto k = static_cast<std::size_t>(333 + x);
    EXPECT_EQ(expected.gradient[k].dx, dx);
    EXPECT_EQ(expected.gradient[k].dy, dy);
    EXPECT_EQ(expected.magnitude[k], (std::abs(dx) + std::abs(dy)) & ~kernels::kFlags);
    peaks += expected.peaks[static_cast<std::size_t>(x)] != 0 ? 1 : 0;
  }
  EXPECT_GT(peaks, 20);

  for (int i = 1; i < count; ++i) {
    const Rows rows = rowsWith(*tables[i]);
    EXPECT_EQ(rows.magnitude, expected.magnitude) << tables[i]->name;
    EXPECT_EQ(rows.peaks, expected.peaks) << tables[i]->name;
    for (std::size_t k = 0; k < rows.gradient.size(); ++k) {
      ASSERT_EQ(rows.gradient[k].dx, expected.gradient[k].dx) << tables[i]->name;
      ASSERT_EQ(rows.gradient[k].dy, expected.gradient[k].dy) << tables[i]->name;
    }
  }
}

TEST(EdgeDetector, FollowsALongStraightEdgeThroughTheLens) {
  const auto camera = eurocCamera();
  const LensBend lens(camera, 752, 480);
  const LineSegment ends{{100.0F, 50.0F}, {640.0F, 60.0F}};
  const cv::Mat image = BentEdge(camera, ends).image(80.0F, 1.0F);
  EdgeDetector detector;
  DetectionHints hints;
  hints.lens = &lens;
  std::vector<LineSegment> lines;
  detector.detect(image, 30.0F, lines, hints);
  EXPECT_LE(lines.size(), 3U);
  EXPECT_GT(lines[0].length(), 500.0F);
  // As straight lines of the image the same edge is in pieces.
  detector.detect(image, 30.0F, lines);
  EXPECT_LT(lines[0].length(), 150.0F);
}

TEST(EdgeDetector, DoesNotFindATrackedLineAgainThatTheLensBends) {
  const auto camera = eurocCamera();
  const LensBend lens(camera, 752, 480);
  const LineSegment ends{{100.0F, 50.0F}, {640.0F, 60.0F}};
  const cv::Mat image = BentEdge(camera, ends).image(80.0F, 1.0F);
  EdgeDetector detector;
  DetectionHints hints;
  hints.lens = &lens;
  std::vector<LineSegment> lines;
  detector.detect(image, 30.0F, lines, hints);
  ASSERT_FALSE(lines.empty());
  for (const LineSegment& line : lines) hints.tracked.push_back(lens.curve(line));
  detector.detect(image, 30.0F, lines, hints);
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace tet_line_tracker
