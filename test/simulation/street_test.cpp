#include "simulation/street.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

Simulation drive(std::uint64_t seed, double seconds = 20.0) {
  SimulationOptions options;
  options.motion = "drive";
  options.seconds = seconds;
  options.rate_hz = 10.0;
  options.seed = seed;
  CameraCalibration camera = streetCamera();
  camera.width = 64;  // no image is looked at here
  camera.height = 40;
  return Simulation(options, makeCameraModel(camera));
}

TEST(Street, IsDrivenAtFiveToFifteenMetresPerSecond) {
  double slowest = 100.0;
  double fastest = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Simulation simulation = drive(seed);
    for (double t = 0.0; t < 20.0; t += 0.1) {
      const auto position = [&](double at) -> Eigen::Vector3d {
        return simulation.trajectory().worldFromCamera(at).translation();
      };
      const double speed = (position(t + 0.005) - position(t - 0.005)).norm() / 0.01;
      slowest = std::min(slowest, speed);
      fastest = std::max(fastest, speed);
    }
  }
  EXPECT_GT(slowest, 5.0);
  EXPECT_LT(slowest, 7.0);
  EXPECT_GT(fastest, 12.5);
  EXPECT_LT(fastest, 15.0);
}

TEST(Street, HasNoHoleAndLeavesTheCameraItsLane) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Simulation simulation = drive(seed);
    double nearest = 100.0;
    for (double t = 0.0; t <= 20.0; t += 0.1) {
      const Eigen::Isometry3d pose = simulation.trajectory().worldFromCamera(t);
      for (int direction = 0; direction < 48; ++direction) {
        const double azimuth = 2.0 * M_PI * direction / 16.0;
        const double elevation = 0.3 * (direction / 16 - 1);
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const auto hit = simulation.geometry().raycast(pose.translation(), ray, simulation.stampAt(t));
        ASSERT_TRUE(hit) << "seed " << seed << " at " << t;
        nearest = std::min(nearest, hit->distance);
      }
    }
    EXPECT_GT(nearest, 1.0) << "seed " << seed;
  }
}

TEST(Street, MovesNearThingsByAHundredPixelsAndMoreBetweenTwoImages) {
  const Simulation simulation = drive(1);
  const auto camera = makeCameraModel(streetCamera());
  int far = 0;   // points above the road that move by less than 8 px
  int near = 0;  // those that move by more than 100 px
  int all = 0;
  for (double t = 0.0; t < 20.0; t += 0.5) {
    const Eigen::Isometry3d now = simulation.trajectory().worldFromCamera(t);
    const Eigen::Isometry3d then = simulation.trajectory().worldFromCamera(t + 0.1);
    for (int y = 5; y < 370; y += 30) {
      for (int x = 5; x < 1236; x += 30) {
        const Eigen::Vector3d ray = now.linear() * *camera->unproject({x, y});
        const auto hit = simulation.geometry().raycast(now.translation(), ray, simulation.stampAt(t));
        ASSERT_TRUE(hit);
        const Eigen::Vector3d point = now.translation() + hit->distance * ray;
        if (point.z() < 0.2) continue;
        ++all;
        const auto moved = camera->project(then.inverse() * point);
        const double px = moved ? (*moved - Eigen::Vector2d(x, y)).norm() : 1000.0;
        far += px < 8.0 ? 1 : 0;
        near += px > 100.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(near, all / 50);
  EXPECT_LT(near, all / 4);
  EXPECT_GT(far, all / 20);
}

TEST(Street, GoesWithTheDriveAlone) {
  SimulationOptions options;
  const auto camera = makeCameraModel(streetCamera());
  options.motion = "slow";
  options.scene = "street";
  EXPECT_THROW(Simulation(options, camera), std::invalid_argument);
  options.motion = "drive";
  options.scene = "room";
  EXPECT_THROW(Simulation(options, camera), std::invalid_argument);
  options.scene = "street";
  options.textureless_phase = true;
  EXPECT_THROW(Simulation(options, camera), std::invalid_argument);
}

TEST(Simulation, BlursEachImageByTheExposureWhateverTheRate) {
  SimulationOptions options;
  options.motion = "fast";
  options.light = "low";  // 20 ms
  options.seconds = 0.5;
  CameraCalibration upper_left = defaultSimulatedCamera();
  upper_left.width = 200;
  upper_left.height = 130;
  const auto camera = makeCameraModel(upper_left);
  Simulation often(options, camera);
  options.rate_hz = 4.0;
  Simulation rarely(options, camera);
  for (int i = 0; i < 2; ++i) {
    const cv::Mat image = rarely.nextImage();
    cv::Mat same_moment;
    const int skipped = i == 0 ? 1 : 5;
    for (int k = 0; k < skipped; ++k) same_moment = often.nextImage();
    ASSERT_EQ(rarely.imageStamp(i), often.imageStamp(5 * i));
    // The noise alone differs, by about a gray level.
    EXPECT_LT(cv::norm(image, same_moment, cv::NORM_L1) / static_cast<double>(image.total()), 1.5);
  }
}

}  // namespace
}  // namespace tet_line_tracker
