#include "tracking/mad_threshold.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(OutlierLimit, LiesEightSpreadsAndTheMarginAboveTheMedian) {
  std::vector<float> values{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F, 9.0F, 10.0F, 100.0F};
  EXPECT_FLOAT_EQ(madThreshold(values, 0.5F), 6.0F + 8.0F * 3.0F + 0.5F);
}

TEST(OutlierLimit, OfEqualValuesIsTheMarginAboveThem) {
  std::vector<float> values(20, 2.0F);
  EXPECT_FLOAT_EQ(madThreshold(values, 1.0F), 3.0F);
}

TEST(OutlierLimit, OfAFewValuesIsInfinite) {
  std::vector<float> values(9, 2.0F);
  EXPECT_GT(madThreshold(values, 1.0F), 1e30F);
}

}  // namespace
}  // namespace tet_line_tracker
