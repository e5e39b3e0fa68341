#include <cmath>

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sys/stat.h>
#include <tf2_msgs/TFMessage.h>

#include "bag_content.h"
#include "dataset_folder.h"

namespace tet_line_tracker {
namespace {

/// Two images 50 ms apart; the body turns by 0.2 rad about its z axis and moves 1 m along x between the two
/// poses of the ground truth; the camera sits 0.1 m along the body's y axis, turned by 90 degrees about z.
class EurocFolder : public DatasetFolder {
 protected:
  void SetUp() override {
    DatasetFolder::SetUp();
    writeImage("mav0/cam0/data/1000000000050000000.png", 1);
    writeImage("mav0/cam0/data/1000000000100000000.png", 2);
    writeText(root() / "mav0/cam0/data.csv",
              "#timestamp [ns],filename\r\n1000000000050000000,1000000000050000000.png\r\n"
              "1000000000100000000,1000000000100000000.png\r\n");
    writeSensor("radial-tangential");
    writeText(root() / "mav0/imu0/data.csv",
              "#timestamp [ns],w,w,w,a,a,a\n1000000000000000000,0.1,0.2,0.3,1,2,9.81\n"
              "1000000000005000000,0.4,0.5,0.6,3,4,9.82\n");
    writeText(root() / "mav0/state_groundtruth_estimate0/data.csv",
              "#timestamp\n1000000000000000000,0,0,0,1,0,0,0\n1000000000100000000,1,0,0," +
                  std::to_string(std::cos(0.1)) + ",0,0," + std::to_string(std::sin(0.1)) + "\n");
  }

  /// The sensor.yaml of another sensor than the camera: 0.3 m along the body's z axis.
  void writePlace(const std::string& sensor, const std::string& last_row = "0, 0, 0, 1") {
    writeText(root() / "mav0" / sensor / "sensor.yaml",
              "%YAML:1.0\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, 0,\n    0, 1, 0, 0,\n    0, 0, 1, "
              "0.3,\n    " +
                  last_row + "]\n");
  }

  void writeSensor(const std::string& model, const std::string& resolution = "16, 12",
                   const std::string& intrinsics = "20, 21, 8, 6",
                   const std::string& distortion = "-0.3, 0.1, 0.001, 0.002") {
    writeText(root() / "mav0/cam0/sensor.yaml",
              "%YAML:1.0\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n"
              "  data: [0, -1, 0, 0, 1, 0, 0, 0.1,\n    0, 0, 1, 0, 0, 0, 0, 1]\n"
              "resolution: [" +
                  resolution + "]\ncamera_model: pinhole\nintrinsics: [" + intrinsics +
                  "] #fu, fv, cu, cv\ndistortion_model: " + model + "\ndistortion_coefficients: [" +
                  distortion + "]\n");
  }
};

TEST_F(EurocFolder, KeepsStampsImagesAndImu) {
  const ToolRun run = convert("euroc");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].message.header.stamp, ros::Time(1000000000, 50000000));
  EXPECT_EQ(images[1].message.header.stamp, ros::Time(1000000000, 100000000));
  EXPECT_EQ(images[1].message.data.at(0), 2);
  const auto imu = readTopic<sensor_msgs::Imu>(bag(), "/imu0");
  ASSERT_EQ(imu.size(), 2U);
  EXPECT_EQ(imu[1].message.header.stamp, ros::Time(1000000000, 5000000));
  EXPECT_EQ(imu[1].message.angular_velocity.y, 0.5);
  EXPECT_EQ(imu[1].message.linear_acceleration.z, 9.82);
  EXPECT_EQ(imu[1].message.header.frame_id, "imu0");
}

TEST_F(EurocFolder, DoesNotWaitForAFifo) {
  for (const char* const name :
       {"mav0/cam0/data.csv", "mav0/cam0/sensor.yaml", "mav0/cam0/data/1000000000100000000.png"}) {
    std::filesystem::rename(root() / name, root() / "aside");
    ASSERT_EQ(mkfifo((root() / name).c_str(), 0600), 0);
    const ToolRun run = runTool("dataset_to_bag", {"euroc", root().string(), bag()}, "timeout -s KILL 60 ");
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.errors, "dataset_to_bag: cannot read " + (root() / name).string() + "\n");
    std::filesystem::rename(root() / "aside", root() / name);
  }
}

TEST_F(EurocFolder, KeepsTheCalibration) {
  ASSERT_EQ(convert("euroc").status, 0);
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
  ASSERT_EQ(infos.size(), 3U);
  const sensor_msgs::CameraInfo& info = infos[0].message;
  EXPECT_EQ(info.width, 16U);
  EXPECT_EQ(info.height, 12U);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, (std::vector<double>{-0.3, 0.1, 0.001, 0.002, 0.0}));
  EXPECT_EQ(info.K[0], 20.0);
  EXPECT_EQ(info.K[4], 21.0);
  EXPECT_EQ(info.K[2], 8.0);
  EXPECT_EQ(info.K[5], 6.0);
}

TEST_F(EurocFolder, KeepsTheEquidistantModel) {
  writeSensor("equidistant");
  ASSERT_EQ(convert("euroc").status, 0);
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
  ASSERT_FALSE(infos.empty());
  EXPECT_EQ(infos[0].message.distortion_model, "equidistant");
  EXPECT_EQ(infos[0].message.D, (std::vector<double>{-0.3, 0.1, 0.001, 0.002}));
}

TEST_F(EurocFolder, GivesCameraPosesAtImageStamps) {
  ASSERT_EQ(convert("euroc").status, 0);
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].message.header.stamp, ros::Time(1000000000, 50000000));
  EXPECT_EQ(poses[0].message.header.frame_id, "world");
  constexpr double kQuarterTurn = 1.5707963267948966;
  // Half-way: the body at x = 0.5, turned by 0.1 rad; the camera's lever arm and turn are on top of it. The
  // position between two samples may be that of the chord: the lever arm keeps that below 1 mm.
  const Eigen::Isometry3d camera = toPose(poses[0].message.pose);
  EXPECT_TRUE(camera.translation().isApprox(
      Eigen::Vector3d(0.5 - 0.1 * std::sin(0.1), 0.1 * std::cos(0.1), 0.0), 1e-3))
      << camera.translation();
  EXPECT_TRUE(camera.linear().isApprox(
      Eigen::AngleAxisd(0.1 + kQuarterTurn, Eigen::Vector3d::UnitZ()).toRotationMatrix(), 1e-6));
  const Eigen::Isometry3d last = toPose(poses[1].message.pose);
  EXPECT_TRUE(last.translation().isApprox(
      Eigen::Vector3d(1.0 - 0.1 * std::sin(0.2), 0.1 * std::cos(0.2), 0.0), 1e-6));
}

TEST_F(EurocFolder, GivesTheExtrinsicAsStaticTransform) {
  ASSERT_EQ(convert("euroc").status, 0);
  const auto tf = readTopic<tf2_msgs::TFMessage>(bag(), "/tf_static");
  ASSERT_EQ(tf.size(), 1U);
  ASSERT_EQ(tf[0].message.transforms.size(), 1U);
  const auto& transform = tf[0].message.transforms[0];
  EXPECT_EQ(transform.header.frame_id, "imu0");
  EXPECT_EQ(transform.child_frame_id, "cam0");
  EXPECT_NEAR(transform.transform.translation.y, 0.1, 1e-12);
  EXPECT_NEAR(transform.transform.rotation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(transform.transform.rotation.w, std::sqrt(0.5), 1e-12);
}

TEST_F(EurocFolder, TakesThePlaceOfTheImuInTheBodyIntoAccount) {
  writePlace("imu0");
  ASSERT_EQ(convert("euroc").status, 0);
  const auto tf = readTopic<tf2_msgs::TFMessage>(bag(), "/tf_static");
  ASSERT_EQ(tf.size(), 1U);
  ASSERT_EQ(tf[0].message.transforms.size(), 1U);
  const auto& translation = tf[0].message.transforms[0].transform.translation;
  EXPECT_NEAR(translation.y, 0.1, 1e-12);
  EXPECT_NEAR(translation.z, -0.3, 1e-12) << "the camera is below the IMU";
}

TEST_F(EurocFolder, TakesThePlaceOfTheTruePosesInTheBodyIntoAccount) {
  writePlace("state_groundtruth_estimate0");
  ASSERT_EQ(convert("euroc").status, 0);
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_NEAR(toPose(poses[1].message.pose).translation().z(), -0.3, 1e-9);
}

TEST_F(EurocFolder, RefusesAPoseThatIsNone) {
  writePlace("imu0", "0, 0, 0.5, 1");
  expectFailure("euroc", "mav0/imu0/sensor.yaml: T_BS is not a rotation and a translation");
}

TEST_F(EurocFolder, LeavesOutPosesWhereTheGroundTruthHasAGap) {
  writeText(root() / "mav0/state_groundtruth_estimate0/data.csv",
            "1000000000000000000,0,0,0,1,0,0,0\n1000000001000000000,1,0,0,1,0,0,0\n");
  ASSERT_EQ(convert("euroc").status, 0);
  EXPECT_TRUE(readTopic<geometry_msgs::PoseStamped>(bag(), "/ground_truth/pose").empty());
}

TEST_F(EurocFolder, NamesFileAndLineOfBadNumbers) {
  writeText(root() / "mav0/imu0/data.csv",
            "#\n1000000000000000000,0.1,0.2,0.3,1,2,9.81\n"
            "1000000000005000000,0.4,o.5,0.6,3,4,9.82\n");
  expectFailure("euroc", "mav0/imu0/data.csv:3: \"o.5\" is not a number");
  writeText(root() / "mav0/imu0/data.csv", "1000000000000000000,0.1,nan,0.3,1,2,9.81\n");
  expectFailure("euroc", "mav0/imu0/data.csv:1: \"nan\" is not a number");
  writeText(root() / "mav0/imu0/data.csv", "1000000000000000000,0.1,0.2,0.3,1,2\n");
  expectFailure("euroc", "mav0/imu0/data.csv:1: 6 fields, needs 7");
  writeText(root() / "mav0/imu0/data.csv", "1e18,0.1,0.2,0.3,1,2,3\n");
  expectFailure("euroc", "mav0/imu0/data.csv:1: \"1e18\" is not a stamp in nanoseconds");
}

TEST_F(EurocFolder, RefusesMissingFilesAndStampsThatGoBack) {
  writeText(root() / "mav0/imu0/data.csv",
            "1000000000005000000,0.1,0.2,0.3,1,2,9.81\n1000000000000000000,0.4,0.5,0.6,3,4,9.82\n");
  expectFailure("euroc", "mav0/imu0/data.csv:2: the stamp is not after that of the line before");
  writeText(root() / "mav0/imu0/data.csv", "1000000000000000000,0.1,0.2,0.3,1,2,9.81\n");
  std::filesystem::remove(root() / "mav0/cam0/data/1000000000100000000.png");
  expectFailure("euroc", "cannot read " + (root() / "mav0/cam0/data/1000000000100000000.png").string());
  writeText(root() / "mav0/cam0/data.csv", "20,a.png\n10,b.png\n");
  expectFailure("euroc", "the stamp of b.png is not after that of a.png");
  std::filesystem::remove(root() / "mav0/cam0/data.csv");
  expectFailure("euroc", "cannot read " + (root() / "mav0/cam0/data.csv").string());
  std::filesystem::remove(root() / "mav0/cam0/sensor.yaml");
  expectFailure("euroc", "cannot read " + (root() / "mav0/cam0/sensor.yaml").string());
  std::filesystem::remove_all(root() / "mav0/cam0");
  expectFailure("euroc", "is a folder");
}

TEST_F(EurocFolder, RefusesAnImplausibleCalibrationAndNamesTheValue) {
  writeSensor("radtan", "16, 12", "0, 21, 8, 6");
  expectFailure("euroc", "mav0/cam0/sensor.yaml: fx is 0");
  writeSensor("radtan", "160.7, 12");
  expectFailure("euroc", "mav0/cam0/sensor.yaml: resolution[0]");
  writeSensor("radtan", "16, 12", "20, 21, 8, 6", "20, 21, 8, 6");
  expectFailure("euroc", "mav0/cam0/sensor.yaml: plumb_bob with coefficients [20, 21, 8, 6, 0]");
}

TEST_F(EurocFolder, RefusesAnUnknownDistortionAndARate) {
  writeSensor("fov");
  expectFailure("euroc", "distortion_model \"fov\" is not known");
  writeSensor("radtan");
  expectFailure("euroc", "--rate was given, but euroc has stamps of its own", {"--rate", "10"});
}

}  // namespace
}  // namespace tet_line_tracker
