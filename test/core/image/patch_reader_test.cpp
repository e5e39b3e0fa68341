#include "image/patch_reader.h"

#include <limits>

#include <gtest/gtest.h>

#include "image/mask.h"

namespace tet_line_tracker {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Gray value is the column plus 10 times the row.
cv::Mat ramp() {
  cv::Mat image(16, 24, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(x + 10 * y);
  }
  return image;
}

TEST(PatchReader, FindsThePixelBelowAndLeftOfThePatch) {
  const cv::Mat image = ramp();
  PatchReader reader(kernels::PatchShape::ofSide(5));
  const kernels::PatchPlace place = reader.patch(image, {8.25F, 6.5F});
  EXPECT_EQ(place.data[0], 6 + 10 * 4);
  EXPECT_EQ(place.data[place.stride + 2], 8 + 10 * 5);
  EXPECT_FLOAT_EQ(place.fraction_x, 0.25F);
  EXPECT_FLOAT_EQ(place.fraction_y, 0.5F);
}

TEST(PatchReader, ReadsTheBorderWhereThePointLiesFarOutsideOrNowhere) {
  const cv::Mat image = ramp();
  PatchReader reader(kernels::PatchShape::ofSide(5));
  const struct {
    Eigen::Vector2f centre;
    int first_pixel;
  } cases[] = {{{-1e30F, 0.0F}, 0},
               {{1e30F, 1e30F}, 23 + 150},
               {{kInfinity, -kInfinity}, 23},
               {{-kInfinity, kInfinity}, 150},
               {{kNan, kNan}, 0},
               {{kNan, 1e30F}, 150}};
  for (const auto& outside : cases) {
    EXPECT_EQ(reader.patch(image, outside.centre).data[0], outside.first_pixel) << outside.centre.transpose();
    EXPECT_EQ(reader.patchWithRim(image, outside.centre).data[0], outside.first_pixel);
  }
}

TEST(Mask, ALineThatIsNowhereIsLookedUpAtTheBorder) {
  const cv::Mat white(16, 24, CV_8UC1, cv::Scalar(255));
  const cv::Mat black(16, 24, CV_8UC1, cv::Scalar(0));
  for (const float value : {kNan, kInfinity, 1e30F}) {
    EXPECT_TRUE(mostlyInMask({{value, 3.0F}, {5.0F, -value}}, white));
    EXPECT_FALSE(mostlyInMask({{value, 3.0F}, {5.0F, -value}}, black));
  }
}

}  // namespace
}  // namespace tet_line_tracker
