#include "tet_line_tracker/camera/lens_bend.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

struct Lens {
  std::string name;
  std::shared_ptr<const CameraModel> camera;
  int width, height;
};

std::shared_ptr<const CameraModel> cameraOf(const std::string& model, int width, int height, double f,
                                            const std::vector<double>& distortion) {
  CameraCalibration calibration;
  calibration.model = model;
  calibration.width = width;
  calibration.height = height;
  calibration.fx = calibration.fy = f;
  calibration.cx = 0.5 * width + 3.0;
  calibration.cy = 0.5 * height - 2.0;
  calibration.distortion = distortion;
  return makeCameraModel(calibration);
}

std::vector<Lens> lenses() {
  return {{"EuRoC", cameraOf("plumb_bob", 752, 480, 458.0, {-0.2834, 0.0740, 0.00019, 1.8e-5}), 752, 480},
          {"TUM fr1", cameraOf("plumb_bob", 640, 480, 517.0, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}), 640,
           480},
          {"equidistant 190", cameraOf("equidistant", 1000, 1000, 300.0, {0.0, 0.0, 0.0, 0.0}), 1000, 1000},
          {"MEI 185", cameraOf("mei", 1000, 1000, 600.0, {0.9, -0.1, 0.01, 0.0, 0.0}), 1000, 1000}};
}

TEST(LensBend, IsWithinAHundredthOfAPixelOfTheProjectedLine) {
  for (const Lens& lens : lenses()) {
    const LensBend bend(lens.camera, lens.width, lens.height);
    EXPECT_FALSE(bend.isStraight()) << lens.name;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> x(5.0F, static_cast<float>(lens.width - 5));
    std::uniform_real_distribution<float> y(5.0F, static_cast<float>(lens.height - 5));
    float worst = 0.0F;
    int judged = 0;
    for (int i = 0; i < 4000; ++i) {
      const LineSegment line{{x(random), y(random)}, {x(random), y(random)}};
      if (line.length() < 30.0F || line.length() > 400.0F) continue;
      const auto start = lens.camera->normalize(line.start.cast<double>());
      const auto end = lens.camera->normalize(line.end.cast<double>());
      if (!start || !end) continue;
      const LineCurve curve = bend.curve(line);
      ++judged;
      const Eigen::Vector3d from = lens.camera->unproject(line.start.cast<double>())->normalized();
      const Eigen::Vector3d to = lens.camera->unproject(line.end.cast<double>())->normalized();
      for (double share = 0.05; share < 1.0; share += 0.05) {
        const auto pixel = lens.camera->project((1.0 - share) * from + share * to);
        ASSERT_TRUE(pixel);
        worst = std::max(worst, std::abs(curve.distance(pixel->cast<float>())));
      }
    }
    std::printf("%s: %d lines, at most %.4f px\n", lens.name.c_str(), judged, static_cast<double>(worst));
    EXPECT_GT(judged, 500) << lens.name;
    EXPECT_LT(worst, 0.01F) << lens.name;
  }
}

TEST(LensBend, ALineGoesOnBeyondItsEndInThePlaneOfItsRays) {
  for (const Lens& lens : lenses()) {
    const LensBend bend(lens.camera, lens.width, lens.height);
    const float w = static_cast<float>(lens.width);
    const float h = static_cast<float>(lens.height);
    // Towards the right, above the centre.
    const LineSegment line{{0.4F * w, 0.25F * h}, {0.55F * w, 0.22F * h}};
    const Eigen::Vector3d plane = lens.camera->unproject(line.start.cast<double>())
                                      ->cross(*lens.camera->unproject(line.end.cast<double>()))
                                      .normalized();
    for (const float distance : {5.0F, 50.0F}) {
      const Eigen::Vector2f pixel = bend.beyond(line, distance);
      const auto ray = lens.camera->unproject(pixel.cast<double>());
      ASSERT_TRUE(ray) << lens.name;
      EXPECT_LT(std::abs(plane.dot(*ray)), 1e-5) << lens.name;
      EXPECT_NEAR((pixel - line.end).norm(), distance, 0.25F * distance) << lens.name;
      EXPECT_GT(line.along(pixel), line.length());
    }
  }
  EXPECT_EQ(LensBend().beyond({{0.0F, 10.0F}, {30.0F, 10.0F}}, 12.0F), Eigen::Vector2f(42.0F, 10.0F));
}

TEST(LensBend, ACameraThatSaysSoBendsNothing) {
  EXPECT_FALSE(cameraOf("plumb_bob", 640, 480, 500.0, {0.0, 0.0, 0.0, 0.0})->bendsLines());
  EXPECT_TRUE(cameraOf("plumb_bob", 640, 480, 500.0, {0.0, 0.0, 0.0, 1e-5})->bendsLines());
  for (const Lens& lens : lenses()) EXPECT_TRUE(lens.camera->bendsLines()) << lens.name;
}

TEST(LensBend, APinholeBendsNothing) {
  const LensBend pinhole(cameraOf("plumb_bob", 640, 480, 500.0, {}), 640, 480);
  EXPECT_TRUE(pinhole.isStraight());
  EXPECT_TRUE(pinhole.between({{10.0F, 10.0F}, {600.0F, 20.0F}}).isStraight());
  EXPECT_TRUE(LensBend().between({{10.0F, 10.0F}, {600.0F, 20.0F}}).isStraight());
}

TEST(LensBend, BarrelDistortionBendsLinesAwayFromTheCentre) {
  const Lens euroc = lenses().front();
  const LensBend bend(euroc.camera, euroc.width, euroc.height);
  // Above the centre, from left to right: the left of the direction on screen is up, away from the centre.
  const LineSegment top{{200.0F, 40.0F}, {550.0F, 40.0F}};
  EXPECT_GT(bend.between(top).offset(0.5F), 3.0F);
  EXPECT_LT(bend.between({top.end, top.start}).offset(0.5F), -3.0F);
  // Through the centre nothing bends.
  EXPECT_NEAR(bend.between({{200.0F, 238.0F}, {550.0F, 238.0F}}).offset(0.5F), 0.0F, 0.02F);
}

TEST(LineBend, SlopeIsTheDerivativeOfOffset) {
  const LineBend bend{{4.0F, -1.5F, 0.7F, 0.4F, -0.2F}};
  for (const float s : {0.1F, 0.4F, 0.5F, 0.9F}) {
    EXPECT_NEAR(bend.slope(s), (bend.offset(s + 0.005F) - bend.offset(s - 0.005F)) / 0.01F, 1e-3F);
  }
  EXPECT_EQ(bend.offset(0.0F), 0.0F);
  EXPECT_EQ(bend.offset(1.0F), 0.0F);
}

}  // namespace
}  // namespace tet_line_tracker
