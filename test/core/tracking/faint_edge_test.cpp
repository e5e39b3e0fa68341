// What LineTracker makes of edges that one image shows with much noise.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "edge_images.h"
#include "rectangle_images.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(320, 240);

/// Four of them, `gray` on 110.
std::vector<Rectangle> rectanglesOf(float gray) {
  return {{40.3F, 40.7F, 130.2F, 110.6F, gray},
          {170.6F, 50.4F, 280.9F, 120.1F, gray},
          {60.2F, 150.8F, 150.5F, 210.3F, gray},
          {190.7F, 140.2F, 260.4F, 200.9F, gray}};
}

/// Distances of the ends of `line` from the side that it shows.
std::array<float, 2> errorsOf(const LineSegment& line, const Eigen::Vector2f& shift) {
  const bool flat = std::abs(line.direction().x()) > std::abs(line.direction().y());
  const auto across = [&](const Eigen::Vector2f& point) { return flat ? point.y() : point.x(); };
  std::array<float, 2> nearest = {1e3F, 1e3F};
  for (const Rectangle& r : rectanglesOf(0.0F)) {
    for (const float side :
         flat ? std::array<float, 2>{r.top, r.bottom} : std::array<float, 2>{r.left, r.right}) {
      const float place = side + (flat ? shift.y() : shift.x());
      const std::array<float, 2> errors = {across(line.start) - place, across(line.end) - place};
      if (std::abs(errors[0] + errors[1]) < std::abs(nearest[0] + nearest[1])) nearest = errors;
    }
  }
  return nearest;
}

struct Errors {
  double squares{0.0};
  double normalized{0.0};
  int ends{0};

  void add(const TrackedLine& line, const Eigen::Vector2f& shift) {
    const std::array<float, 2> errors = errorsOf(line.segment, shift);
    for (const std::size_t end : {0U, 1U}) {
      const auto square = static_cast<double>(errors[end] * errors[end]);
      squares += square;
      normalized += square / static_cast<double>(line.covariance_px[2 * end]);
      ++ends;
    }
  }
  double rms() const { return std::sqrt(squares / ends); }
  double normalizedRms() const { return std::sqrt(normalized / ends); }
};

/// Errors of lines that were followed for a while, through noisy images that move by `step` px a side from
/// one to the next; and of fits to the same edges in the last image alone.
struct Compared {
  Errors followed, fitted;
};
Compared follow(float step, float contrast) {
  LineTrackerParameters parameters;
  parameters.detection.min_length = 40;
  LineTracker tracker(parameters);
  const LineRefiner refiner(parameters.refiner);
  Compared compared;
  for (int i = 0; i < 40; ++i) {
    Similarity placed;
    placed.shift.setConstant(step * static_cast<float>(i));
    const cv::Mat clear = rectanglesImage(kSize, rectanglesOf(110.0F + contrast), placed);
    const cv::Mat image = withNoise(clear, 3.0, static_cast<unsigned>(i));
    const FrameResult result = tracker.process(image, 1000000000 + 50000000LL * i);
    for (const TrackedLine& line : result.frame->lines) {
      if (line.age < 8) continue;
      const EdgeFit fit = refiner.fit(image, line.segment, refiner.contrastOf(image, line.segment));
      if (!(fit.sigma_px > 0.0F)) continue;
      TrackedLine alone = line;
      alone.segment = fit.segment;
      alone.covariance_px = fit.covariance_px;
      compared.followed.add(line, placed.shift);
      compared.fitted.add(alone, placed.shift);
    }
  }
  return compared;
}

/// Lines that were followed err less than `share` of what fits to one image do; over what they claim, by
/// `normalized` or more.
void expectBetter(const Compared& compared, double share, double normalized) {
  ASSERT_GE(compared.followed.ends, 200);
  EXPECT_LT(compared.followed.rms(), share * compared.fitted.rms());
  EXPECT_GT(compared.followed.normalizedRms(), normalized);
  EXPECT_LT(compared.followed.normalizedRms(), 1.3);
}

TEST(FaintEdge, IsKnownBetterByAllImagesThanByTheLastOne) {
  expectBetter(follow(0.45F, 12.0F), 0.9, 0.7);
}

TEST(FaintEdge, IsKnownBetterByAllImagesWhereNothingMovesToo) {
  expectBetter(follow(0.0F, 12.0F), 0.9, 0.7);
}

TEST(FaintEdge, IsAveragedWhileNothingMovesByMoreThanTheDeadBand) {
  expectBetter(follow(0.0F, 40.0F), 0.7, 0.6);
}

}  // namespace
}  // namespace tet_line_tracker
