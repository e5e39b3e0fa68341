#include "evaluation/scene_truth.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(SceneTruth, AThingThatTurnsHidesWhatIsBehindItWhereItIsAtThatTime) {
  // A panel of 1 m at x = 2 that stands across x, and along it a second later, when the camera is beside it.
  MovingBody body;
  body.centre = {2.0, 0.0, 0.0};
  body.swing = Eigen::Vector3d::Zero();
  body.turn_rad = 0.5 * M_PI;
  body.turn_period_s = 4.0;
  SceneGeometry scene;
  const int number = scene.addBody(body);
  scene.addRectangle(
      {{0.0, -0.5, -0.5}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), 1.0, 1.0, number});
  CameraCalibration calibration;
  calibration.model = "plumb_bob";
  calibration.width = 400;
  calibration.height = 300;
  calibration.fx = calibration.fy = 100.0;
  PoseTrack poses;
  constexpr std::int64_t kSecond = 1000000000;
  poses.add(0, Eigen::Isometry3d::Identity());
  Eigen::Isometry3d beside = Eigen::Isometry3d::Identity();
  beside.translation() = Eigen::Vector3d(2.0, -2.0, 0.0);
  poses.add(kSecond, beside);
  poses.sort();
  const SceneTruth truth(scene, poses, makeCameraModel(calibration));
  EXPECT_TRUE(truth.isHidden({4.0, 0.3, 0.0}, 0));
  EXPECT_FALSE(truth.isHidden({4.0, 1.3, 0.0}, 0)) << "past its side";
  EXPECT_FALSE(truth.isHidden({1.5, 0.1, 0.0}, 0)) << "before it";
  EXPECT_TRUE(truth.isHidden({2.1, 2.0, 0.0}, kSecond));
  EXPECT_FALSE(truth.isHidden({3.5, 2.0, 0.0}, kSecond)) << "past its side";
}

}  // namespace
}  // namespace tet_line_tracker
