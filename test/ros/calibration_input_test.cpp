#include "calibration_input.h"

#include <gtest/gtest.h>

#include "synthetic_scene.h"

namespace tet_line_tracker {
namespace {

using synthetic_scene::cameraInfo;

TEST(CalibrationInput, TellsOnceThatNoCameraInfoCame) {
  CalibrationInput input;
  int told = 0;
  for (int i = 0; i < 100; ++i) {
    const CalibrationInput::Model model = input.modelFor(320, 240);
    EXPECT_EQ(model.camera, nullptr);
    told += static_cast<int>(model.complaint.has_value());
  }
  EXPECT_EQ(told, 1);
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

TEST(CalibrationInput, TellsOnceThatTheSizeDoesNotFit) {
  CalibrationInput input;
  input.update(cameraInfo(ros::Time(1)));
  const CalibrationInput::Model model = input.modelFor(640, 480);
  EXPECT_EQ(model.camera, nullptr);
  ASSERT_TRUE(model.complaint);
  EXPECT_NE(model.complaint->find("320x240"), std::string::npos);
  EXPECT_NE(model.complaint->find("640x480"), std::string::npos);
  EXPECT_FALSE(input.modelFor(640, 480).complaint);
  EXPECT_NE(input.modelFor(320, 240).camera, nullptr);
}

TEST(CalibrationInput, TellsOnceThatACameraInfoCannotBeUsed) {
  CalibrationInput input;
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.distortion_model = "fish_scales";
  const auto complaint = input.update(info);
  ASSERT_TRUE(complaint);
  EXPECT_NE(complaint->find("fish_scales"), std::string::npos) << *complaint;
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

}  // namespace
}  // namespace tet_line_tracker
