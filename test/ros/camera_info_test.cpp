#include "camera_info.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

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

TEST(CameraInfo, IsAnotherCalibrationWhenAnythingOfItIsAnother) {
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.D.assign(5, std::numeric_limits<double>::quiet_NaN());
  sensor_msgs::CameraInfo later = info;
  later.header.stamp = ros::Time(2);
  EXPECT_TRUE(sameCalibration(info, later)) << "NaN is the same as NaN";
  using Info = sensor_msgs::CameraInfo;
  const std::vector<std::function<void(Info&)>> changes{[](Info& i) { i.distortion_model = "equidistant"; },
                                                        [](Info& i) { ++i.width; },
                                                        [](Info& i) { ++i.height; },
                                                        [](Info& i) { ++i.binning_x; },
                                                        [](Info& i) { ++i.binning_y; },
                                                        [](Info& i) { ++i.roi.x_offset; },
                                                        [](Info& i) { ++i.roi.y_offset; },
                                                        [](Info& i) { ++i.roi.width; },
                                                        [](Info& i) { ++i.roi.height; },
                                                        [](Info& i) { i.K[4] += 1.0; },
                                                        [](Info& i) { i.D[1] = 0.0; },
                                                        [](Info& i) { i.D.pop_back(); }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    sensor_msgs::CameraInfo other = info;
    changes[k](other);
    EXPECT_FALSE(sameCalibration(info, other)) << "change " << k;
  }
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

/// 640x480 of which the camera reads 400x300 at (100, 60) in pixels of 2x3.
sensor_msgs::CameraInfo partOfAnImage() {
  sensor_msgs::CameraInfo info = cameraInfo(ros::Time(1));
  info.width = 640;
  info.height = 480;
  info.K = {450.0, 0, 330.0, 0, 460.0, 230.0, 0, 0, 1};
  info.D = {-0.28, 0.07, 0.0002, 0.00002, 0.0};
  info.roi.x_offset = 100;
  info.roi.y_offset = 60;
  info.roi.width = 400;
  info.roi.height = 300;
  info.binning_x = 2;
  info.binning_y = 3;
  return info;
}

TEST(CameraInfo, OfAPartOfTheImageGivesTheRaysOfTheFullOne) {
  sensor_msgs::CameraInfo full = partOfAnImage();
  full.roi = sensor_msgs::RegionOfInterest();
  full.binning_x = full.binning_y = 0;
  const CameraChoice whole = chooseCamera(full, 640, 480);
  const CameraChoice part = chooseCamera(partOfAnImage(), 200, 100);
  ASSERT_NE(whole.camera, nullptr) << whole.problem;
  ASSERT_NE(part.camera, nullptr) << part.problem;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0.0, 0.0), {199.0, 3.0}, {120.5, 99.0}}) {
    const auto seen = part.camera->normalize(pixel);
    const auto expected = whole.camera->normalize({100.0 + 2.0 * pixel.x(), 60.0 + 3.0 * pixel.y()});
    ASSERT_TRUE(seen && expected);
    EXPECT_LT((*seen - *expected).norm(), 1e-9) << pixel.transpose();
  }
}

TEST(CameraInfo, OfAPartOfTheImageFitsImagesOfThatPartOnly) {
  EXPECT_EQ(chooseCamera(partOfAnImage(), 640, 480).problem,
            "camera_info is for images of 200x100 (640x480, region of interest 400x300 at (100, 60), binning "
            "2x3), the images have 640x480");
  sensor_msgs::CameraInfo binned = partOfAnImage();
  binned.roi = sensor_msgs::RegionOfInterest();
  EXPECT_NE(chooseCamera(binned, 320, 160).camera, nullptr);
  EXPECT_EQ(chooseCamera(binned, 640, 480).problem,
            "camera_info is for images of 320x160 (640x480, binning 2x3), the images have 640x480");
  sensor_msgs::CameraInfo rest = partOfAnImage();  // some drivers give the offset alone
  rest.roi.width = rest.roi.height = rest.binning_x = rest.binning_y = 0;
  EXPECT_NE(chooseCamera(rest, 540, 420).camera, nullptr);
}

TEST(CameraInfo, OfAPartThatCannotBeMeantIsRefused) {
  const auto problemOf = [](std::uint32_t x_offset, std::uint32_t roi_width, std::uint32_t binning) {
    sensor_msgs::CameraInfo info = partOfAnImage();
    info.roi.x_offset = x_offset;
    info.roi.width = roi_width;
    info.binning_x = binning;
    const CameraChoice choice = chooseCamera(info, 200, 100);
    EXPECT_EQ(choice.camera, nullptr);
    return choice.problem;
  };
  const std::string outside =
      "camera_info cannot be used: its region of interest is not inside the full image";
  EXPECT_EQ(problemOf(300, 400, 2).rfind(outside + " (640x480, ", 0), 0U) << problemOf(300, 400, 2);
  EXPECT_EQ(problemOf(640, 0, 2).rfind(outside, 0), 0U) << problemOf(640, 0, 2);
  EXPECT_EQ(problemOf(kHuge, kHuge, 2).rfind(outside, 0), 0U) << problemOf(kHuge, kHuge, 2);
  const std::string nothing = "camera_info cannot be used: its binning leaves no pixel of the image";
  EXPECT_EQ(problemOf(100, 400, kHuge).rfind(nothing, 0), 0U) << problemOf(100, 400, kHuge);
  EXPECT_EQ(problemOf(100, 400, 401).rfind(nothing, 0), 0U) << problemOf(100, 400, 401);
}

}  // namespace
}  // namespace tet_line_tracker
