#include "display/label_placer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace tet_line_tracker {
namespace {

const cv::Size kImage(200, 100);
const cv::Size kLabel(20, 8);
const LineCurve kLine(LineSegment{{20.0F, 50.0F}, {180.0F, 50.0F}});

cv::Rect areaOf(const cv::Point& lower_left) {
  return {lower_left.x, lower_left.y - kLabel.height, kLabel.width, kLabel.height};
}

TEST(LabelPlacer, PutsTheFirstLabelBesideTheMiddleAndClearOfTheLine) {
  LabelPlacer placer(kImage);
  placer.take(kLine);
  const auto corner = placer.place(kLine, kLabel);
  ASSERT_TRUE(corner);
  const cv::Rect area = areaOf(*corner);
  EXPECT_NEAR(area.x + kLabel.width / 2, 100, 2);
  EXPECT_TRUE(area.y > 50 || area.y + area.height < 50);
  EXPECT_LT(std::abs(area.y + area.height / 2 - 50), 12);
}

TEST(LabelPlacer, NoTwoLabelsOverlapAndWhenThereIsNoRoomThereIsNone) {
  LabelPlacer placer(kImage);
  placer.take(kLine);
  std::vector<cv::Rect> areas;
  while (const auto corner = placer.place(kLine, kLabel)) {
    for (const cv::Rect& other : areas) EXPECT_TRUE((areaOf(*corner) & other).empty());
    areas.push_back(areaOf(*corner));
    ASSERT_LT(areas.size(), 20U);
  }
  EXPECT_EQ(areas.size(), 10U);
}

TEST(LabelPlacer, LeavesAnotherLineFree) {
  LabelPlacer placer(kImage);
  placer.take(kLine);
  for (const float y : {42.0F, 58.0F}) placer.take(LineCurve(LineSegment{{0.0F, y}, {199.0F, y}}));
  EXPECT_FALSE(placer.place(kLine, kLabel));
}

TEST(LabelPlacer, LeavesWhatIsTakenFree) {
  LabelPlacer placer(kImage);
  placer.take(cv::Rect(0, 51, 200, 49));
  const auto corner = placer.place(kLine, kLabel);
  ASSERT_TRUE(corner);
  EXPECT_LT(corner->y, 51);
}

TEST(LabelPlacer, PutsNothingOutsideTheImage) {
  LabelPlacer placer(kImage);
  EXPECT_FALSE(placer.place(LineCurve(LineSegment{{-300.0F, 50.0F}, {-100.0F, 50.0F}}), kLabel));
  EXPECT_FALSE(placer.place(kLine, cv::Size(300, 8)));
}

}  // namespace
}  // namespace tet_line_tracker
