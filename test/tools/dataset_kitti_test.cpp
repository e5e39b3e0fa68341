#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "bag_content.h"
#include "dataset_folder.h"

namespace tet_line_tracker {
namespace {

class KittiFolder : public DatasetFolder {
 protected:
  void SetUp() override {
    DatasetFolder::SetUp();
    writeImage("image_0/000000.png", 1);
    writeImage("image_0/000001.png", 2);
    writeText(root() / "times.txt", "0.000000e+00\n1.037000e-01\n");
    writeText(root() / "calib.txt",
              "P0: 7.0e+02 0 8 0 0 7.1e+02 6 0 0 0 1 0\nP2: 700 0 8 -42 0 710 6 0 0 0 1 0\n");
    // The second pose: a turn of 90 degrees about y, at (1, 2, 3).
    writeText(root() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 1 1 0 1 0 2 -1 0 0 3\n");
  }
};

TEST_F(KittiFolder, KeepsTimesFromOneSecondOn) {
  const ToolRun run = convert("kitti");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].message.header.stamp, ros::Time(1, 0));
  EXPECT_EQ(images[1].message.header.stamp, ros::Time(1, 103700000));
  EXPECT_EQ(images[1].message.data.at(0), 2);
}

TEST_F(KittiFolder, KeepsCalibrationAndPoses) {
  ASSERT_EQ(convert("kitti").status, 0);
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
  ASSERT_EQ(infos.size(), 3U);
  EXPECT_EQ(infos[0].message.K[0], 700.0);
  EXPECT_EQ(infos[0].message.K[2], 8.0);
  EXPECT_EQ(infos[0].message.K[4], 710.0);
  EXPECT_EQ(infos[0].message.K[5], 6.0);
  EXPECT_EQ(infos[0].message.width, 16U);
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].message.header.stamp, ros::Time(1, 103700000));
  const Eigen::Isometry3d pose = toPose(poses[1].message.pose);
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
}

TEST_F(KittiFolder, MovesThePosesOfTheColourCameraByItsBaseline) {
  std::filesystem::rename(root() / "image_0", root() / "image_2");
  ASSERT_EQ(convert("kitti").status, 0);
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(poses.size(), 2U);
  // P2 says -42 / 700: this camera sits 6 cm to the right, which after the turn is along -z.
  EXPECT_TRUE(toPose(poses[0].message.pose).translation().isApprox(Eigen::Vector3d(0.06, 0, 0), 1e-12));
  EXPECT_TRUE(toPose(poses[1].message.pose).translation().isApprox(Eigen::Vector3d(1, 2, 2.94), 1e-12));
}

TEST_F(KittiFolder, FindsPosesWhereTheWholeDownloadKeepsThem) {
  const std::filesystem::path sequence = root() / "sequences" / "00";
  for (const char* name : {"image_0", "times.txt", "calib.txt"}) {
    std::filesystem::create_directories(sequence);
    std::filesystem::rename(root() / name, sequence / name);
  }
  std::filesystem::create_directories(root() / "poses");
  std::filesystem::rename(root() / "poses.txt", root() / "poses" / "00.txt");
  ASSERT_EQ(runTool("dataset_to_bag", {"kitti", sequence.string(), bag()}).status, 0);
  EXPECT_EQ(readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose").size(), 2U);
}

TEST_F(KittiFolder, NamesWhatIsBroken) {
  writeText(root() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectFailure("kitti", "poses.txt has 1 poses for 2 images");
  writeText(root() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 2 0 0 0 0 1 0\n");
  expectFailure("kitti", "poses.txt:2: the left 3x3 part is not a rotation");
  writeText(root() / "times.txt", "0\n");
  expectFailure("kitti", "times.txt has 1 stamps for 2 images");
  writeText(root() / "times.txt", "0\nsoon\n");
  expectFailure("kitti", "times.txt:2: \"soon\" is not a number");
  writeText(root() / "times.txt", "0\n0.1\n");
  writeText(root() / "calib.txt", "P0: 7.0e+02 0 8\n");
  expectFailure("kitti", "calib.txt:1: P0 has 3 numbers, needs 12");
  writeText(root() / "calib.txt", "P1: 7.0e+02 0 8 0 0 7.1e+02 6 0 0 0 1 0\n");
  expectFailure("kitti", "calib.txt holds no line P0:");
  std::filesystem::remove_all(root() / "image_0");
  expectFailure("kitti", "image_0 is not a folder");
}

}  // namespace
}  // namespace tet_line_tracker
