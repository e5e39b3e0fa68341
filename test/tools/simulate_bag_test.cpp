#include <fstream>
#include <iterator>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include "bag_content.h"
#include "simulation/scene_geometry.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

std::string bytesOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(SimulateBag, GivesTheSameBytesForTheSameArgumentsWhateverTheNumberOfThreads) {
  const TemporaryFolder folder;
  const std::string one = folder.path() / "one.bag";
  const std::string two = folder.path() / "two.bag";
  const std::string other = folder.path() / "other.bag";
  const std::vector<std::string> arguments{"--seconds", "0.1", "--light", "gain_jumps", "--moving-object"};
  const auto run = [&](const std::string& bag, const std::vector<std::string>& more) {
    std::vector<std::string> all{bag};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), more.begin(), more.end());
    const ToolRun result = runTool("simulate_bag", all);
    ASSERT_EQ(result.status, 0) << result.errors;
  };
  run(one, {"--threads", "1"});
  run(two, {"--threads", "3"});
  run(other, {"--seed", "2"});
  EXPECT_EQ(bytesOf(one), bytesOf(two));
  EXPECT_NE(bytesOf(one), bytesOf(other));
}

TEST(SimulateBag, LatchesStaticTransformsForThoseWhoCouldNotSubscribeInTime) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "slow.bag";
  const ToolRun run = runTool("simulate_bag", {path, "--seconds", "0.2"});
  ASSERT_EQ(run.status, 0) << run.errors;
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  const auto connections = rosbag::View(bag, rosbag::TopicQuery("/tf_static")).getConnections();
  ASSERT_EQ(connections.size(), 1U);
  ros::M_string& header = *connections[0]->header;
  EXPECT_EQ(header["latching"], "1");
  // Players take these from there.
  EXPECT_EQ(header["type"], "tf2_msgs/TFMessage");
  EXPECT_EQ(header["md5sum"], ros::message_traits::md5sum<tf2_msgs::TFMessage>());
  EXPECT_NE(header["message_definition"], "");
}

TEST(SimulateBag, HoldsAllThatTheJudgeAndAnEstimatorNeed) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "slow.bag";
  const ToolRun run = runTool("simulate_bag", {bag, "--seconds", "0.2", "--light", "low,drift"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.output.find(bag + ": 5 images, "), 0U) << run.output;

  const auto images = readTopic<sensor_msgs::Image>(bag, "/cam0/image_raw");
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag, "/ground_truth/pose");
  ASSERT_EQ(images.size(), 5U);
  ASSERT_EQ(poses.size(), 5U);
  EXPECT_EQ(readTopic<sensor_msgs::CameraInfo>(bag, "/cam0/camera_info").size(), 6U);
  EXPECT_EQ(readTopic<tf2_msgs::TFMessage>(bag, "/tf").size(), 5U);
  EXPECT_EQ(readTopic<tf2_msgs::TFMessage>(bag, "/tf_static").size(), 1U);
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(images[i].message.header.stamp, poses[i].message.header.stamp);
    EXPECT_NEAR(images[i].message.header.stamp.toSec(), 1000.0 + 0.05 * static_cast<double>(i), 1e-9);
  }

  const auto imu = readTopic<sensor_msgs::Imu>(bag, "/imu0");
  ASSERT_GT(imu.size(), 40U);
  EXPECT_LT(imu.front().message.header.stamp, images.front().message.header.stamp);
  EXPECT_GT(imu.back().message.header.stamp, images.back().message.header.stamp);

  const auto scenes = readTopic<std_msgs::String>(bag, kSceneTopic);
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_LT(scenes[0].bag_time, images[0].bag_time);
  const SceneGeometry geometry = SceneGeometry::fromText(scenes[0].message.data);
  EXPECT_EQ(geometry.arguments().front(), (std::pair<std::string, std::string>("scene", "room")));
  const Eigen::Isometry3d camera = toPose(poses[0].message.pose);
  EXPECT_TRUE(geometry.raycast(camera.translation(), camera.linear().col(2), 1000000000000));
}

TEST(SimulateBag, StampsTheImuLaterByTheOffset) {
  const TemporaryFolder folder;
  const std::string in_step = folder.path() / "in_step.bag";
  const std::string late = folder.path() / "late.bag";
  ASSERT_EQ(runTool("simulate_bag", {in_step, "--seconds", "0.05"}).status, 0);
  ASSERT_EQ(runTool("simulate_bag", {late, "--seconds", "0.05", "--imu-time-offset", "0.02"}).status, 0);
  const auto expected = readTopic<sensor_msgs::Imu>(in_step, "/imu0");
  const auto imu = readTopic<sensor_msgs::Imu>(late, "/imu0");
  ASSERT_EQ(imu.size(), expected.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_NEAR((imu[i].message.header.stamp - expected[i].message.header.stamp).toSec(), 0.02, 1e-8);
    EXPECT_EQ(imu[i].message.angular_velocity.x, expected[i].message.angular_velocity.x);
  }
  EXPECT_EQ(readTopic<sensor_msgs::Image>(late, "/cam0/image_raw").size(), 2U);
}

TEST(SimulateBag, TurnsTheImuAndAddsItsBias) {
  const TemporaryFolder folder;
  const std::string good = folder.path() / "good.bag";
  const std::string bad = folder.path() / "bad.bag";
  const std::vector<std::string> arguments{"--seconds", "0.05", "--noise-free-imu"};
  const auto simulate = [&](std::vector<std::string> bag) {
    bag.insert(bag.end(), arguments.begin(), arguments.end());
    return runTool("simulate_bag", bag).status;
  };
  ASSERT_EQ(simulate({good}), 0);
  ASSERT_EQ(simulate({bad, "--imu-bias", "0.2", "--imu-misalignment", "2"}), 0);
  const auto expected = readTopic<sensor_msgs::Imu>(good, "/imu0");
  const auto imu = readTopic<sensor_msgs::Imu>(bad, "/imu0");
  ASSERT_EQ(imu.size(), expected.size());
  const Eigen::AngleAxisd turn(2.0 * M_PI / 180.0, Eigen::Vector3d(2.0, -1.0, 1.0).normalized());
  const auto vectorOf = [](const geometry_msgs::Vector3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  for (std::size_t i = 0; i < imu.size(); ++i) {
    const Eigen::Vector3d rate = turn.inverse() * vectorOf(expected[i].message.angular_velocity);
    const Eigen::Vector3d measured = vectorOf(imu[i].message.angular_velocity);
    EXPECT_LT((measured - rate - Eigen::Vector3d::Constant(0.2)).norm(), 1e-6);
    const Eigen::Vector3d force = turn.inverse() * vectorOf(expected[i].message.linear_acceleration);
    EXPECT_LT((vectorOf(imu[i].message.linear_acceleration) - force).norm(), 1e-3);
  }
  // The transform does not know of it.
  const auto transformOf = [](const std::string& bag) {
    return readTopic<tf2_msgs::TFMessage>(bag, "/tf_static").at(0).message.transforms.at(0);
  };
  EXPECT_EQ(transformOf(good), transformOf(bad));
}

TEST(SimulateBag, WritesAnOdometryWithTheFrameThatMovesWithTheCamera) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "driven.bag";
  ASSERT_EQ(runTool("simulate_bag", {bag, "--motion", "drive", "--seconds", "0.3", "--odometry"}).status, 0);
  const auto poses = readTopic<nav_msgs::Odometry>(bag, "/odom");
  const auto images = readTopic<sensor_msgs::Image>(bag, "/cam0/image_raw");
  ASSERT_GT(poses.size(), 20U);
  EXPECT_EQ(poses[0].message.child_frame_id, "base_link");
  EXPECT_LT(poses.front().message.header.stamp, images.front().message.header.stamp);
  EXPECT_GT(poses.back().message.header.stamp, images.back().message.header.stamp);
  EXPECT_GT(poses.back().message.pose.pose.position.x, 1.0);
  const auto frames = readTopic<tf2_msgs::TFMessage>(bag, "/tf_static");
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].message.transforms.size(), 2U);
  EXPECT_EQ(frames[0].message.transforms[1].header.frame_id, "cam0");
  EXPECT_EQ(frames[0].message.transforms[1].child_frame_id, "base_link");
}

TEST(SimulateBag, DrivesAlongTheStreetAtTenImagesPerSecondWithKittisCamera) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "street.bag";
  const ToolRun run = runTool("simulate_bag", {bag, "--motion", "drive", "--seconds", "0.1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.output.find(bag + ": 2 images, "), 0U) << run.output;
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag, "/cam0/camera_info");
  ASSERT_FALSE(infos.empty());
  EXPECT_EQ(infos[0].message.width, 1241U);
  EXPECT_EQ(infos[0].message.height, 376U);
  EXPECT_NEAR(infos[0].message.K[0], 718.856, 1e-9);
}

TEST(SimulateBag, EndsWithASentenceAndNoBagOnBadInput) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "never.bag";
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--motion", "sideways"},
                                                {"--scene", "cellar"},
                                                {"--light", "candle"},
                                                {"--seconds", "-1"},
                                                {"--rate", "0"},
                                                {"--imu-time-offset", "0.6"},
                                                {"--imu-bias", "1.5"},
                                                {"--imu-misalignment", "-1"},
                                                {"--motion", "drive", "--scene", "room"},
                                                {"--scene", "room", "--motion", "corridor"}}) {
    std::vector<std::string> arguments{bag};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const ToolRun run = runTool("simulate_bag", arguments);
    EXPECT_NE(run.status, 0) << wrong.back();
    EXPECT_NE(run.errors.find("simulate_bag: "), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << wrong.back();
  }
}

}  // namespace
}  // namespace tet_line_tracker
