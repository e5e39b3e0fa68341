#include "calibration_input.h"

#include <gtest/gtest.h>

#include <limits>

#include "synthetic_scene.h"

namespace tet_line_tracker {
namespace {

using synthetic_scene::cameraInfo;

TEST(CalibrationInput, WarnsOnceThatNoCameraInfoCame) {
  CalibrationInput input;
  int warnings = 0;
  for (int i = 0; i < 100; ++i) {
    const CalibrationInput::Model model = input.modelFor(320, 240);
    EXPECT_EQ(model.camera, nullptr);
    warnings += static_cast<int>(model.warning.has_value());
  }
  EXPECT_EQ(warnings, 1);
}

TEST(CalibrationInput, KeepsTheModelWhileTheCameraInfoStaysTheSame) {
  CalibrationInput input;
  EXPECT_FALSE(input.update(cameraInfo(ros::Time(1))));
  const auto camera = input.modelFor(320, 240).camera;
  ASSERT_NE(camera, nullptr);
  EXPECT_FALSE(input.update(cameraInfo(ros::Time(2))));
  EXPECT_EQ(input.modelFor(320, 240).camera, camera);

  sensor_msgs::CameraInfo other = cameraInfo(ros::Time(3));
  other.K[0] = 400.0;
  EXPECT_FALSE(input.update(other));
  EXPECT_EQ(input.modelFor(320, 240).camera->calibration().fx, 400.0);
}

TEST(CalibrationInput, WarnsOnceThatTheSizeDoesNotFit) {
  CalibrationInput input;
  input.update(cameraInfo(ros::Time(1)));
  const CalibrationInput::Model model = input.modelFor(640, 480);
  EXPECT_EQ(model.camera, nullptr);
  ASSERT_TRUE(model.warning);
  EXPECT_NE(model.warning->find("320x240"), std::string::npos);
  EXPECT_NE(model.warning->find("640x480"), std::string::npos);
  EXPECT_FALSE(input.modelFor(640, 480).warning);
  EXPECT_NE(input.modelFor(320, 240).camera, nullptr);
}

TEST(CalibrationInput, WarnsOnceThatACameraInfoCannotBeUsed) {
  CalibrationInput input;
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.distortion_model = "fish_scales";
  const auto warning = input.update(info);
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("fish_scales"), std::string::npos) << *warning;
  EXPECT_FALSE(input.update(info));
  EXPECT_EQ(input.modelFor(320, 240).camera, nullptr);

  sensor_msgs::CameraInfo typed = cameraInfo(ros::Time(2));
  typed.D = {458.654, 457.296, 367.215, 248.375};  // the intrinsics of EuRoC
  const auto implausible = input.update(typed);
  ASSERT_TRUE(implausible);
  EXPECT_NE(implausible->find("458.654"), std::string::npos) << *implausible;
  EXPECT_EQ(input.modelFor(320, 240).camera, nullptr);
  sensor_msgs::CameraInfo huge = cameraInfo(ros::Time(3));
  huge.width = 4294967295U;
  const auto too_wide = input.update(huge);
  ASSERT_TRUE(too_wide);
  EXPECT_NE(too_wide->find("width is 2147483647 px"), std::string::npos) << *too_wide;

  sensor_msgs::CameraInfo uncalibrated;  // as drivers publish it without a calibration file: all zero
  EXPECT_TRUE(input.update(uncalibrated));
}

TEST(CalibrationInput, TheStateIsThatOfTheLastImage) {
  CalibrationInput input;
  EXPECT_EQ(input.state(), "no camera_info so far");
  input.update(cameraInfo(ros::Time(1)));
  EXPECT_EQ(input.state(), "plumb_bob, 320x240");
  input.modelFor(640, 480);
  EXPECT_EQ(input.state(), "camera_info is for images of 320x240, the images have 640x480");
  input.modelFor(320, 240);
  EXPECT_EQ(input.state(), "plumb_bob, 320x240");
}

TEST(CalibrationInput, WarnsOnceOfACameraInfoOfNans) {
  CalibrationInput input;
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.K[2] = info.D[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(input.update(info));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(input.update(info));
  info.K[2] = 160.0;
  EXPECT_TRUE(input.update(info));  // another one, with another trouble
}

TEST(CalibrationInput, AHugeSizeIsRefusedAndNeverPrintedAsNegative) {
  CalibrationInput input;
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.width = info.height = std::numeric_limits<std::uint32_t>::max();
  const auto warning = input.update(info);
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->find("-1"), std::string::npos) << *warning;
  EXPECT_EQ(input.modelFor(320, 240).camera, nullptr);
  EXPECT_EQ(input.state().find("-1"), std::string::npos) << input.state();
}

TEST(CalibrationInput, KOfZerosMeansNotCalibrated) {
  CalibrationInput input;
  const auto warning = input.update(sensor_msgs::CameraInfo());
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->rfind("the camera is not calibrated", 0), 0U) << *warning;
  EXPECT_FALSE(input.modelFor(320, 240).warning);
  EXPECT_EQ(input.state(), "the camera is not calibrated (K[0] of camera_info is 0)");
}

TEST(CalibrationInput, TakesOverBinningThatChangesInFlight) {
  CalibrationInput input;
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  input.update(info);
  ASSERT_NE(input.modelFor(320, 240).camera, nullptr);
  info.binning_x = info.binning_y = 2;
  EXPECT_FALSE(input.update(info));
  const auto camera = input.modelFor(160, 120).camera;
  ASSERT_NE(camera, nullptr);
  EXPECT_EQ(camera->calibration().fx, 125.0);
  EXPECT_EQ(input.state(), "plumb_bob, 160x120 (320x240, binning 2x2)");
  info.roi.x_offset = 20;
  info.roi.width = 200;
  EXPECT_FALSE(input.update(info));
  EXPECT_EQ(input.modelFor(100, 120).camera->calibration().cx, 70.0);
}

}  // namespace
}  // namespace tet_line_tracker
