#include "camera_info.h"

#include <gtest/gtest.h>

#include <limits>

#include "synthetic_scene.h"

namespace tet_line_tracker {
namespace {

using synthetic_scene::cameraInfo;

constexpr std::uint32_t kHuge = std::numeric_limits<std::uint32_t>::max();

TEST(CameraInfo, GivesACameraForImagesOfItsSize) {
  const CameraChoice choice = chooseCamera(cameraInfo(ros::Time(1)), 320, 240);
  EXPECT_NE(choice.camera, nullptr);
  EXPECT_EQ(choice.problem, "");
}

TEST(CameraInfo, GivesNoCameraForImagesOfAnotherSize) {
  const CameraChoice choice = chooseCamera(cameraInfo(ros::Time(1)), 640, 240);
  EXPECT_EQ(choice.camera, nullptr);
  EXPECT_EQ(choice.problem, "camera_info is for images of 320x240, the images have 640x240");
  EXPECT_EQ(chooseCamera(cameraInfo(ros::Time(1)), 320, 480).camera, nullptr);
}

TEST(CameraInfo, WithoutASizeFitsEveryImage) {
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.width = info.height = 0;
  EXPECT_NE(chooseCamera(info, 640, 480).camera, nullptr);
}

TEST(CameraInfo, OfZerosMeansACameraThatIsNotCalibrated) {
  const CameraChoice choice = chooseCamera(sensor_msgs::CameraInfo(), 320, 240);
  EXPECT_EQ(choice.camera, nullptr);
  EXPECT_EQ(choice.problem, "the camera is not calibrated (K[0] of camera_info is 0)");
}

TEST(CameraInfo, ThatCannotBeUsedIsAProblemAndNoException) {
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.distortion_model = "fish_scales";
  const CameraChoice choice = chooseCamera(info, 320, 240);
  EXPECT_EQ(choice.camera, nullptr);
  EXPECT_NE(choice.problem.find("fish_scales"), std::string::npos) << choice.problem;
}

TEST(CameraInfo, ASizeThatIntDoesNotHoldStaysLarge) {
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.width = kHuge;
  EXPECT_EQ(fromCameraInfo(info).width, std::numeric_limits<int>::max());
  EXPECT_EQ(fromCameraInfo(info).height, 240);
  EXPECT_EQ(sizeProblem(info, 320, 240),
            "camera_info is for images of 4294967295x240, the images have 320x240");
}

}  // namespace
}  // namespace tet_line_tracker
