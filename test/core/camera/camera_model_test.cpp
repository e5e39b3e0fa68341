#include "tet_line_tracker/camera/camera_model.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

struct RealCamera {
  const char* name;
  CameraCalibration calibration;
  /// Where OpenCV 4.6 (projectPoints of calib3d, fisheye and ccalib's omnidir) puts the point (0.7,
  /// -0.4, 1.2).
  Eigen::Vector2d opencv_pixel;
  /// Angle to the optical axis that the manufacturer or the data set says the image circle reaches; 0: the
  /// whole rectangle [rad].
  double field{0.0};
};

CameraCalibration calibrationOf(const char* model, int width, int height, double fx, double fy, double cx,
                                double cy, std::vector<double> distortion) {
  CameraCalibration c;
  c.model = model;
  c.width = width;
  c.height = height;
  c.fx = fx;
  c.fy = fy;
  c.cx = cx;
  c.cy = cy;
  c.distortion = std::move(distortion);
  return c;
}

const double kDegree = std::acos(-1.0) / 180.0;

std::vector<RealCamera> realCameras() {
  return {
      {"EuRoC cam0",
       calibrationOf("plumb_bob", 752, 480, 458.654, 457.296, 367.215, 248.375,
                     {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}),
       {604.542841404, 113.202666018}},
      {"TUM freiburg1",
       calibrationOf("plumb_bob", 640, 480, 517.3, 516.5, 318.6, 255.3,
                     {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}),
       {632.393662222, 75.354052459}},
      {"Azure Kinect colour",
       calibrationOf("rational_polynomial", 1280, 720, 605.2, 605.0, 637.6, 366.1,
                     {0.513059, -2.77779, -0.000323, 0.000703, 1.62693, 0.391017, -2.593868, 1.548565}),
       {1002.277142079, 157.803423254}},
      {"TUM-VI cam0 (195 degrees)",
       calibrationOf("equidistant", 512, 512, 190.978, 190.973, 254.93, 256.90,
                     {0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673}),
       {353.143807569, 200.779293583},
       97.0 * kDegree},
      {"KITTI-360 fisheye (185 degrees)",
       calibrationOf("mei", 1400, 1400, 1336.3220825849971, 1335.7883350012958, 716.94323510126321,
                     705.76498308221585,
                     {2.213404750785489, 1.6798235660113681e-02, 1.6548773243373522, 4.2223943394772046e-04,
                      4.2462134260997584e-04}),
       {930.093632440, 584.043225236},
       92.0 * kDegree},
  };
}

std::string messageOf(const CameraCalibration& calibration) {
  try {
    makeCameraModel(calibration);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CameraModel, ProjectsAsOpenCvDoes) {
  for (const RealCamera& real : realCameras()) {
    const auto pixel = makeCameraModel(real.calibration)->project({0.7, -0.4, 1.2});
    ASSERT_TRUE(pixel) << real.name;
    // OpenCV gave 32-bit numbers.
    EXPECT_LT((*pixel - real.opencv_pixel).norm(), 1e-4) << real.name << " " << pixel->transpose();
  }
}

TEST(CameraModel, SeesBehindTheCameraAsOpenCvDoes) {
  const auto pixel = makeCameraModel(realCameras().back().calibration)->project({0.9, 0.1, -0.05});
  ASSERT_TRUE(pixel);
  EXPECT_LT((*pixel - Eigen::Vector2d(1380.557399233, 779.577666011)).norm(), 2e-4);
}

TEST(CameraModel, UndistortsTheWholeImageToOneHundredMillionthOfTheUnitPlane) {
  for (const RealCamera& real : realCameras()) {
    const auto camera = makeCameraModel(real.calibration);
    constexpr int kSteps = 60;
    int valid = 0;
    int in_field = 0;
    for (int row = 0; row <= kSteps; ++row) {
      for (int column = 0; column <= kSteps; ++column) {
        // From the outer border of the corner pixels to that of the opposite ones.
        const Eigen::Vector2d pixel(-0.5 + real.calibration.width * static_cast<double>(column) / kSteps,
                                    -0.5 + real.calibration.height * static_cast<double>(row) / kSteps);
        const auto ray = camera->unproject(pixel);
        if (!ray) {
          ASSERT_GT(real.field, 0.0) << real.name << " " << pixel.transpose();
          continue;
        }
        ++valid;
        ASSERT_NEAR(ray->norm(), 1.0, 1e-12);
        if (std::acos(ray->z()) < real.field) ++in_field;
        const auto again = camera->project(*ray);
        ASSERT_TRUE(again) << real.name << " " << pixel.transpose();
        ASSERT_LT((*again - pixel).norm(), 1e-8) << real.name << " " << pixel.transpose();
        const auto ray_again = camera->unproject(*again);
        ASSERT_TRUE(ray_again);
        ASSERT_LT((*ray_again - *ray).norm(), 1e-8) << real.name << " " << pixel.transpose();
        const auto ideal = camera->normalize(pixel);
        ASSERT_EQ(ideal.has_value(), ray->z() >= kMinForward) << real.name;
        if (!ideal) continue;
        ASSERT_LT((*camera->normalize(*again) - *ideal).norm(), 1e-8)
            << real.name << " " << pixel.transpose();
      }
    }
    // A round image circle fills pi/4 of its square.
    const int all = (kSteps + 1) * (kSteps + 1);
    EXPECT_GE(real.field == 0.0 ? valid : in_field, real.field == 0.0 ? all : all * 6 / 10) << real.name;
  }
}

TEST(CameraModel, FindsTheRayThatAPointCameFrom) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  for (const RealCamera& real : realCameras()) {
    const auto camera = makeCameraModel(real.calibration);
    int seen = 0;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d ray = Eigen::Vector3d(noise(random), noise(random), noise(random)).normalized();
      const auto pixel = camera->project(ray);
      if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > real.calibration.width - 1 ||
          pixel->y() > real.calibration.height - 1) {
        continue;
      }
      ++seen;
      const auto found = camera->unproject(*pixel);
      ASSERT_TRUE(found) << real.name << " " << ray.transpose();
      ASSERT_LT((*found - ray).norm(), 1e-8) << real.name << " " << ray.transpose();
    }
    EXPECT_GT(seen, 100) << real.name;
  }
}

TEST(CameraModel, FollowsItsPolynomialToTheEndOfItsRange) {
  const std::vector<std::vector<double>> lenses{
      {0.0, 0.0, 0.0, 0.0},                                         // to 180 degrees
      {0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673},  // TUM-VI
      {-0.05, 0.0, 0.0, 0.0},                                       // to 148 degrees, where it turns
      {-0.2, 0.0, 0.0, 0.0}};                                       // to 74 degrees
  for (const std::vector<double>& k : lenses) {
    const auto camera =
        makeCameraModel(calibrationOf("equidistant", 512, 512, 191.0, 189.0, 254.93, 256.9, k));
    double last = 0.0;
    for (double angle = 0.0; angle < 3.1415; angle += 0.0007) {
      const double a2 = angle * angle;
      if (1.0 + a2 * (3.0 * k[0] + a2 * (5.0 * k[1] + a2 * (7.0 * k[2] + a2 * 9.0 * k[3]))) < 1e-3) break;
      const double radius = angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
      const double turn = 40.0 * angle;
      const Eigen::Vector3d ray(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                                std::cos(angle));
      const Eigen::Vector2d expected(191.0 * radius * std::cos(turn) + 254.93,
                                     189.0 * radius * std::sin(turn) + 256.9);
      const auto pixel = camera->project(3.0 * ray);
      ASSERT_TRUE(pixel) << angle;
      ASSERT_LT((*pixel - expected).norm(), 1e-8) << angle;
      const auto found = camera->unproject(expected);
      ASSERT_TRUE(found) << angle;
      ASSERT_LT((*found - ray).norm(), 1e-8) << angle;
      last = angle;
    }
    EXPECT_GT(last, 1.28);
    if (last < 3.0) {
      // Behind the end, where the radius shrinks again, two rays would share a pixel.
      const double radius = last * (1.0 + last * last * k[0]);
      EXPECT_FALSE(camera->project({std::sin(last + 0.1), 0.0, std::cos(last + 0.1)})) << last;
      EXPECT_FALSE(camera->unproject({1.01 * 191.0 * radius + 254.93, 256.9})) << last;
    }
    const auto principal = camera->project({0.0, 0.0, 2.0});
    ASSERT_TRUE(principal);
    EXPECT_EQ(*principal, Eigen::Vector2d(254.93, 256.9));
    EXPECT_FALSE(camera->project({0.0, 0.0, -1.0})) << "every direction in the image is as good as any other";
  }
}

TEST(CameraModel, KeepsAMirroredImageAxis) {
  // ICL-NUIM has fy < 0.
  const auto camera = makeCameraModel(calibrationOf("plumb_bob", 640, 480, 481.2, -480.0, 319.5, 239.5, {}));
  const auto ideal = camera->normalize({319.5, 0.0});
  ASSERT_TRUE(ideal);
  EXPECT_NEAR(ideal->y(), 239.5 / 480.0, 1e-12);
}

TEST(CameraModel, GivesNoRayWhereTheDistortionFoldsBack) {
  // r (1 - 0.5 r^2) is largest, 0.5443, at r = 0.8165.
  const auto camera =
      makeCameraModel(calibrationOf("plumb_bob", 400, 400, 100, 100, 200, 200, {-0.5, 0, 0, 0}));
  EXPECT_TRUE(camera->unproject({200.0 + 54.0, 200.0}));
  EXPECT_FALSE(camera->unproject({200.0 + 55.0, 200.0}));
  EXPECT_TRUE(camera->project({0.81, 0.0, 1.0}));
  EXPECT_FALSE(camera->project({0.82, 0.0, 1.0}));
}

TEST(CameraModel, PlumbBobSeesNothingBehind) {
  const auto camera = makeCameraModel(realCameras().front().calibration);
  EXPECT_FALSE(camera->project({0.1, 0.1, -1.0}));
  EXPECT_FALSE(camera->project({0.1, 0.1, 0.0}));
  EXPECT_FALSE(camera->unproject({std::numeric_limits<double>::quiet_NaN(), 0.0}));
}

TEST(CameraModel, NamesTheFieldAtFault) {
  const CameraCalibration good = realCameras().front().calibration;
  CameraCalibration bad = good;
  bad.fy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(messageOf(bad).find("fy"), std::string::npos) << messageOf(bad);
  bad = good;
  bad.distortion[2] = std::numeric_limits<double>::infinity();
  EXPECT_NE(messageOf(bad).find("coefficient 2"), std::string::npos) << messageOf(bad);
  bad = good;
  bad.fx = 0.0;
  EXPECT_NE(messageOf(bad).find("fx is 0"), std::string::npos) << messageOf(bad);
  bad = good;
  bad.model = "scaramuzza";
  EXPECT_NE(messageOf(bad).find("scaramuzza"), std::string::npos) << messageOf(bad);
  for (const char* model : {"plumb_bob", "rational_polynomial", "equidistant", "mei"}) {
    bad = good;
    bad.model = model;
    bad.distortion = {0.1, 0.2, 0.3};
    EXPECT_NE(messageOf(bad).find(std::string(model) + " has 3"), std::string::npos) << messageOf(bad);
  }
  bad = good;
  bad.model = "rational_polynomial";
  bad.distortion.assign(12, 0.0);
  EXPECT_EQ(messageOf(bad), "");
  bad.distortion[9] = 0.01;
  EXPECT_NE(messageOf(bad).find("coefficient 9"), std::string::npos) << messageOf(bad);
  bad = good;
  bad.model = "mei";
  bad.distortion = {-0.5, 0, 0, 0, 0};
  EXPECT_NE(messageOf(bad).find("xi"), std::string::npos) << messageOf(bad);
}

}  // namespace
}  // namespace tet_line_tracker
