// Lines of LineTracker that grow along their edges from image to image.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "rectangle_images.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

const cv::Size kSize(640, 400);

/// Follows level lines near row 150, the upper edge of a bright bar.
class Growth : public testing::Test {
 protected:
  /// The lines there after the next image, oldest first.
  std::vector<TrackedLine> track(const std::vector<Rectangle>& rectangles) {
    const LineFrame* frame =
        tracker_.process(rectanglesImage(kSize, rectangles), 1000000000 + 50000000 * images_++).frame;
    duplicates_ += frame->statistics.lostFor(LossReason::kDuplicate);
    std::vector<TrackedLine> lines;
    for (const TrackedLine& line : frame->lines) {
      // Brighter below: from right to left.
      if (std::abs(line.segment.middle().y() - 150.0F) < 4.0F &&
          line.segment.start.x() > line.segment.end.x())
        lines.push_back(line);
    }
    return lines;
  }

  LineTracker tracker_{LineTrackerParameters{}};
  std::int64_t images_{0};
  std::uint32_t duplicates_{0};
};

TEST_F(Growth, TwoTracksOfOneEdgeBecomeOneWhenTheGapBetweenThemCloses) {
  const auto bar = [](float x) { return Rectangle{60.0F + x, 149.5F, 560.0F + x, 349.5F, 170.0F}; };
  std::vector<TrackedLine> lines;
  for (int k = 0; k < 3; ++k) {
    const float x = 0.7F * static_cast<float>(k);
    lines = track({bar(x), {280.0F + x, 90.0F, 340.0F + x, 200.0F, 110.0F}});
    ASSERT_EQ(lines.size(), 2U) << k;
  }
  const std::set<std::uint64_t> ids{lines[0].id, lines[1].id};
  for (int k = 3; k < 24; ++k) lines = track({bar(0.7F * static_cast<float>(k))});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].id, *ids.begin()) << "the older one";
  EXPECT_EQ(lines[0].age, 24U);
  EXPECT_GE(duplicates_, 1U);
  EXPECT_GT(lines[0].segment.length(), 480.0F);
  EXPECT_NEAR(lines[0].segment.start.y(), 149.5F, 0.1F);
  EXPECT_NEAR(lines[0].segment.end.y(), 149.5F, 0.1F);
}

TEST_F(Growth, AnEdgeThatComesIntoViewMakesItsLineLonger) {
  // It reaches from the right border to where it comes in.
  std::vector<TrackedLine> lines;
  std::uint64_t id = 0;
  for (int k = 0; k < 30; ++k) {
    const float left = 540.0F - 8.0F * static_cast<float>(k);
    lines = track({{left, 149.5F, 1200.0F, 349.5F, 170.0F}});
    ASSERT_EQ(lines.size(), 1U) << k;
    if (k == 0) id = lines[0].id;
    EXPECT_EQ(lines[0].id, id);
    EXPECT_NEAR(lines[0].segment.start.x(), 637.0F, 12.0F) << k;
    EXPECT_TRUE(lines[0].cut & kStartCut || k % 4 != 0);
  }
  EXPECT_GT(lines[0].segment.length(), 300.0F);
}

}  // namespace
}  // namespace tet_line_tracker
