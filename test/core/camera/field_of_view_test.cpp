#include "camera/field_of_view.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr int kSize = 400;
constexpr float kMinLength = 30.0F;

std::shared_ptr<const CameraModel> cameraOf(const char* model, double focal_length,
                                            std::vector<double> distortion) {
  CameraCalibration calibration;
  calibration.model = model;
  calibration.fx = calibration.fy = focal_length;
  calibration.cx = calibration.cy = 199.5;
  calibration.distortion = std::move(distortion);
  return makeCameraModel(calibration);
}

/// 190 degrees in a circle of 380 px, 168.5 of them in front of the camera.
const std::shared_ptr<const CameraModel> kFisheye = cameraOf("equidistant", 114.6, {0, 0, 0, 0});
const float kRadius = 114.6F * static_cast<float>(std::acos(kMinForward));

FieldOfView viewOf(std::shared_ptr<const CameraModel> camera) {
  return {std::move(camera), ImageBounds::ofImage(kSize, kSize)};
}

TEST(FieldOfView, LeavesSegmentsInViewAsTheyAre) {
  const LineSegment segment{{150.3F, 180.1F}, {299.7F, 210.2F}};
  for (const auto& camera : {std::shared_ptr<const CameraModel>(),
                             cameraOf("plumb_bob", 300.0, {-0.2, 0.05, 0.0, 0.0}), kFisheye}) {
    const auto clipped = viewOf(camera).clip(segment, kMinLength);
    ASSERT_TRUE(clipped);
    EXPECT_EQ(clipped->start, segment.start);
    EXPECT_EQ(clipped->end, segment.end);
  }
}

TEST(FieldOfView, CutsAtTheCircleAndKeepsTheRolesOfTheEnds) {
  const FieldOfView view = viewOf(kFisheye);
  const auto end_cut = view.clip(LineSegment{{199.5F, 199.5F}, {399.0F, 199.5F}}, kMinLength);
  ASSERT_TRUE(end_cut);
  EXPECT_EQ(end_cut->start, Eigen::Vector2f(199.5F, 199.5F));
  EXPECT_NEAR(end_cut->end.x(), 199.5F + kRadius, 0.01F);
  const auto start_cut = view.clip(LineSegment{{399.0F, 199.5F}, {199.5F, 199.5F}}, kMinLength);
  ASSERT_TRUE(start_cut);
  EXPECT_NEAR(start_cut->start.x(), 199.5F + kRadius, 0.01F);
  EXPECT_EQ(start_cut->end, Eigen::Vector2f(199.5F, 199.5F));
  const auto both_cut = view.clip(LineSegment{{0.0F, 199.5F}, {399.0F, 199.5F}}, kMinLength);
  ASSERT_TRUE(both_cut);
  EXPECT_NEAR(both_cut->start.x(), 199.5F - kRadius, 0.01F);
  EXPECT_NEAR(both_cut->end.x(), 199.5F + kRadius, 0.01F);
}

TEST(FieldOfView, LeavesOutWhatIsTooShortInView) {
  const FieldOfView view = viewOf(kFisheye);
  const float border = 199.5F + kRadius;
  EXPECT_FALSE(view.clip(LineSegment{{border - 29.0F, 199.5F}, {399.0F, 199.5F}}, kMinLength));
  EXPECT_TRUE(view.clip(LineSegment{{border - 31.0F, 199.5F}, {399.0F, 199.5F}}, kMinLength));
  EXPECT_FALSE(view.clip(LineSegment{{border + 1.0F, 100.0F}, {border + 1.0F, 300.0F}}, kMinLength));
  // A chord of twice the root of r^2 - d^2, both ends beyond the circle.
  const auto chord = [&](float length) {
    const float x = 199.5F + std::sqrt(kRadius * kRadius - 0.25F * length * length);
    return LineSegment{{x, 50.0F}, {x, 377.0F}};
  };
  EXPECT_FALSE(view.clip(chord(29.0F), kMinLength));
  EXPECT_TRUE(view.clip(chord(31.0F), kMinLength));
}

TEST(FieldOfView, EveryEndThatItGivesCanBeNormalized) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> inside(0.0F, kSize - 1.0F);
  for (const auto& camera : {kFisheye, cameraOf("mei", 250.0, {1.2, 0.05, 0.01, 1e-3, -1e-3}),
                             cameraOf("plumb_bob", 150.0, {-0.4, 0.0, 0.0, 0.0})}) {
    const FieldOfView view = viewOf(camera);
    int cut = 0;
    int left_out = 0;
    for (int i = 0; i < 5000; ++i) {
      const LineSegment segment{{inside(random), inside(random)}, {inside(random), inside(random)}};
      const auto clipped = view.clip(segment, kMinLength);
      left_out += clipped ? 0 : 1;
      if (!clipped) continue;
      cut += clipped->start != segment.start || clipped->end != segment.end ? 1 : 0;
      ASSERT_TRUE(camera->normalize(clipped->start.cast<double>()));
      ASSERT_TRUE(camera->normalize(clipped->end.cast<double>()));
      ASSERT_LT(std::abs(segment.distance(clipped->start)), 0.01F);
      ASSERT_LT(std::abs(segment.distance(clipped->end)), 0.01F);
    }
    EXPECT_GT(cut, 100) << camera->calibration().model;
    EXPECT_GT(left_out, 10) << camera->calibration().model;
  }
}

}  // namespace
}  // namespace tet_line_tracker
