#include <cmath>

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <opencv2/imgcodecs.hpp>

#include "bag_content.h"
#include "dataset_folder.h"
#include "tet_line_tracker/camera/calibration_file.h"

namespace tet_line_tracker {
namespace {

/// TUM RGB-D and ICL-NUIM store depth alike.
class RgbdFolder : public DatasetFolder {
 protected:
  void writeDepth(const std::string& name, int value) {
    std::filesystem::create_directories((root() / name).parent_path());
    ASSERT_TRUE(cv::imwrite((root() / name).string(), cv::Mat(12, 16, CV_16UC1, cv::Scalar::all(value))));
  }

  static int depthMm(const sensor_msgs::Image& image) { return image.data.at(0) + 256 * image.data.at(1); }
};

class TumFolder : public RgbdFolder {
 protected:
  void SetUp() override {
    RgbdFolder::SetUp();
    writeImage("rgb/a.png", 1, CV_8UC3);
    writeImage("rgb/b.png", 2, CV_8UC3);
    writeDepth("depth/a.png", 5000);
    writeDepth("depth/b.png", 6543);
    writeText(root() / "rgb.txt",
              "# color images\n1341836541.000321 rgb/a.png\n1341836541.050000 rgb/b.png\n");
    writeText(root() / "depth.txt", "# depth\n1341836541.000338 depth/a.png\n1341836541.060 depth/b.png\n");
    writeText(root() / "groundtruth.txt",
              "# truth\n1341836541.0000 1 2 3 0 0 0 1\n1341836541.1000 2 4 6 0 0 0.0998334 0.9950042\n");
    writeText(
        root() / "camera.yaml",
        "image_width: 16\nimage_height: 12\n"
        "camera_matrix: {rows: 3, cols: 3, data: [20, 0, 8, 0, 21, 6, 0, 0, 1]}\n"
        "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n");
  }

  std::vector<std::string> camera() const { return {"--camera-info", (root() / "camera.yaml").string()}; }
};

TEST_F(TumFolder, KeepsStampsOfImagesAndDepthApart) {
  const ToolRun run = convert("tum", camera());
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].message.header.stamp, ros::Time(1341836541, 321000));
  EXPECT_EQ(images[1].message.header.stamp, ros::Time(1341836541, 50000000));
  EXPECT_EQ(images[1].message.encoding, "bgr8");
  EXPECT_EQ(images[1].message.data.at(0), 2);
  const auto depth = readTopic<sensor_msgs::Image>(bag(), "/depth/image_raw");
  ASSERT_EQ(depth.size(), 2U);
  EXPECT_EQ(depth[0].message.header.stamp, ros::Time(1341836541, 338000));
  EXPECT_EQ(depth[0].message.encoding, "16UC1");
  EXPECT_EQ(depthMm(depth[0].message), 1000) << "5000 units are one metre";
  EXPECT_EQ(depthMm(depth[1].message), 1309);
}

TEST_F(TumFolder, InterpolatesPosesAtImageStamps) {
  ASSERT_EQ(convert("tum", camera()).status, 0);
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].message.header.stamp, ros::Time(1341836541, 50000000));
  const Eigen::Isometry3d pose = toPose(poses[1].message.pose);
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1.5, 3.0, 4.5), 1e-9));
  EXPECT_TRUE(
      pose.linear().isApprox(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix(), 1e-6));
}

TEST_F(TumFolder, WorksWithoutDepthAndGroundTruth) {
  std::filesystem::remove(root() / "depth.txt");
  std::filesystem::remove(root() / "groundtruth.txt");
  ASSERT_EQ(convert("tum", camera()).status, 0);
  EXPECT_EQ(readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw").size(), 2U);
  EXPECT_TRUE(readTopic<sensor_msgs::Image>(bag(), "/depth/image_raw").empty());
}

TEST_F(TumFolder, TellsTheSensorByTheNameOfTheFolder) {
  expectFailure("tum", "--camera-info is needed");
  writeImage("rgb/a.png", 1, CV_8UC1, {640, 480});
  writeImage("rgb/b.png", 2, CV_8UC1, {640, 480});
  std::filesystem::path folder = root();
  for (const char* sensor : {"1", "2", "3"}) {
    const std::filesystem::path named =
        root().parent_path() / (std::string("rgbd_dataset_freiburg") + sensor + "_desk");
    std::filesystem::rename(folder, named);
    folder = named;
    const ToolRun run = runTool("dataset_to_bag", {"tum", named.string(), bag()});
    ASSERT_EQ(run.status, 0) << run.errors;
    const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
    ASSERT_EQ(infos.size(), 3U);
    const CameraCalibration file =
        readCalibrationFile(TET_SOURCE_DIRECTORY "/config/tum_freiburg" + std::string(sensor) + ".yaml")
            .camera;
    EXPECT_EQ(infos[0].message.K[0], file.fx);
    EXPECT_EQ(infos[0].message.K[4], file.fy);
    EXPECT_EQ(infos[0].message.K[2], file.cx);
    EXPECT_EQ(infos[0].message.K[5], file.cy);
    EXPECT_EQ(infos[0].message.D, file.distortion);
  }
}

TEST_F(TumFolder, NamesWhatIsBroken) {
  cutOff("depth/b.png");
  expectFailure("tum", "depth/b.png is cut off", camera());
  writeImage("depth/b.png", 1);
  expectFailure("tum", "depth/b.png is not a 16-bit gray image", camera());
  writeText(root() / "groundtruth.txt", "1341836541.0 1 2 3 0 0 0 x\n");
  expectFailure("tum", "groundtruth.txt:1: \"x\" is not a number", camera());
  writeText(root() / "groundtruth.txt", "1341836541.0 1 2 3 0 0 0 0.5\n");
  expectFailure("tum", "groundtruth.txt:1: the quaternion has norm 0.5", camera());
  std::filesystem::remove(root() / "rgb.txt");
  expectFailure("tum", "cannot read " + (root() / "rgb.txt").string(), camera());
}

class IclNuimFolder : public RgbdFolder {
 protected:
  void SetUp() override {
    RgbdFolder::SetUp();
    for (const char* name : {"rgb/0.png", "rgb/1.png", "rgb/3.png"}) {
      writeImage(name, name[4] - '0', CV_8UC3, {640, 480});
    }
    for (const char* name : {"depth/0.png", "depth/1.png", "depth/3.png"}) writeDepth(name, 10000);
    writeText(root() / "associations.txt",
              "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n"
              "3 depth/3.png 3 rgb/3.png\n");
    writeText(root() / "groundtruth.txt",
              "0 0 0 -2.25 0 0 0 1\n1 0 0 -2.26 0 0 0 1\n3 0.5 0.25 -2.28 0 0 0 1\n");
  }
};

TEST_F(IclNuimFolder, TurnsFrameNumbersIntoStampsFromOneSecondOn) {
  const ToolRun run = convert("icl_nuim");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  const auto depth = readTopic<sensor_msgs::Image>(bag(), "/depth/image_raw");
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(images.size(), 3U);
  ASSERT_EQ(depth.size(), 3U);
  ASSERT_EQ(poses.size(), 3U);
  const double stamps_s[] = {1.0, 1.0 + 1.0 / 30.0, 1.1};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(images[i].message.header.stamp.toSec(), stamps_s[i], 1e-8);
    EXPECT_EQ(depth[i].message.header.stamp, images[i].message.header.stamp);
    EXPECT_EQ(poses[i].message.header.stamp, images[i].message.header.stamp);
    EXPECT_EQ(depthMm(depth[i].message), 2000);
  }
  EXPECT_EQ(images[2].message.data.at(0), 3);
  EXPECT_TRUE(toPose(poses[2].message.pose).translation().isApprox(Eigen::Vector3d(0.5, 0.25, -2.28)));
}

TEST_F(IclNuimFolder, KeepsTheNegativeFocalLength) {
  ASSERT_EQ(convert("icl_nuim").status, 0);
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
  ASSERT_EQ(infos.size(), 4U);
  EXPECT_EQ(infos[0].message.K[0], 481.2);
  EXPECT_EQ(infos[0].message.K[4], -480.0);
  EXPECT_EQ(infos[0].message.P[5], -480.0);
  EXPECT_EQ(infos[0].message.K[2], 319.5);
  EXPECT_EQ(infos[0].message.K[5], 239.5);
}

TEST_F(IclNuimFolder, TakesTheOtherOrderAndThePublishedNameOfTheTrajectory) {
  std::filesystem::rename(root() / "groundtruth.txt", root() / "traj0.gt.freiburg");
  writeText(root() / "associations.txt", "0 rgb/0.png 0 depth/0.png\n3 rgb/3.png 3 depth/3.png\n");
  ASSERT_EQ(convert("icl_nuim", {"--rate", "10"}).status, 0);
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[1].message.encoding, "bgr8");
  EXPECT_NEAR(images[1].message.header.stamp.toSec(), 1.3, 1e-8);
  EXPECT_EQ(readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose").size(), 2U);
}

TEST_F(IclNuimFolder, NamesWhatIsBroken) {
  std::filesystem::remove(root() / "rgb/3.png");
  expectFailure("icl_nuim", "cannot read " + (root() / "rgb/3.png").string());
  writeText(root() / "associations.txt", "0 depth/0.png 0 rgb/0.png\n1.5 depth/1.png 1 rgb/1.png\n");
  expectFailure("icl_nuim", "associations.txt:2: \"1.5\" is not a frame number");
  writeText(root() / "associations.txt", "0 rgb/0.png 0 rgb/0.png\n");
  expectFailure("icl_nuim", "associations.txt:1: needs one image below depth/");
  writeText(root() / "associations.txt", "# nothing\n");
  expectFailure("icl_nuim", "lists no images");
}

}  // namespace
}  // namespace tet_line_tracker
