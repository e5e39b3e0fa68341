/// Nodelets in one manager, each with its own image topic, are fed with pictures and judged by their
/// messages.

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>

#include "node_stream.h"

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;
namespace scene = synthetic_scene;

/// What the manager has logged since the first test.
ManagerLog* manager_log = nullptr;

TEST(Nodelet, PublishesEveryImageWithIdsThatStay) {
  Stream stream("plain");
  ASSERT_TRUE(stream.connected());
  stream.send(scene::cameraInfo(kStart));
  stream.sendPictures(0, 40);
  ASSERT_TRUE(stream.receives(40));
  for (std::size_t i = 0; i < 40; ++i) {
    const LineArray& message = stream.lines[i];
    EXPECT_EQ(message.header.seq, i);
    EXPECT_EQ(message.header.stamp, kStart + kPeriod * static_cast<double>(i));
    EXPECT_EQ(message.header.frame_id, scene::kFrame);
    EXPECT_EQ(message.image_count, i + 1);
    EXPECT_EQ(message.width, static_cast<std::uint32_t>(scene::kWidth));
    EXPECT_GE(message.lines.size(), 10U);
  }
  expectContiguousIds(stream.lines);
  const std::set<std::uint64_t> first = idsOf(stream.lines.front());
  const std::set<std::uint64_t> last = idsOf(stream.lines.back());
  const auto alive =
      std::count_if(first.begin(), first.end(), [&](std::uint64_t id) { return last.count(id); });
  EXPECT_GE(alive, static_cast<std::ptrdiff_t>(first.size() / 2));
  EXPECT_EQ(stream.lines.back().lines.front().age, 40U);
}

TEST(Nodelet, ShowsLinesOnlyWhileSomebodyLooks) {
  Stream stream("shown");
  ASSERT_TRUE(stream.connected());
  ros::NodeHandle node;
  std::vector<sensor_msgs::Image> pictures;
  std::vector<visualization_msgs::MarkerArray> markers;
  const auto take_picture = [&](const sensor_msgs::Image::ConstPtr& m) { pictures.push_back(*m); };
  const auto take_markers = [&](const visualization_msgs::MarkerArray::ConstPtr& m) {
    markers.push_back(*m);
  };
  const auto pictures_in = node.subscribe<sensor_msgs::Image>("/shown/debug_image", 50, take_picture);
  const auto markers_in = node.subscribe<visualization_msgs::MarkerArray>("/shown/markers", 50, take_markers);
  ASSERT_TRUE(
      waitFor([&] { return pictures_in.getNumPublishers() == 1 && markers_in.getNumPublishers() == 1; }));
  // The connection is complete on the other side a moment later: send until the first picture comes.
  stream.send(scene::cameraInfo(kStart));
  int sent = 0;
  ASSERT_TRUE(waitFor([&] {
    if (static_cast<int>(stream.lines.size()) == sent) stream.sendPictures(sent, sent + 1), ++sent;
    return !pictures.empty() && markers.size() >= 2;
  }));
  EXPECT_EQ(pictures.front().encoding, encodings::BGR8);
  EXPECT_EQ(pictures.front().header.frame_id, scene::kFrame);
  EXPECT_EQ(pictures.front().width, static_cast<std::uint32_t>(scene::kWidth));
  ASSERT_EQ(markers.back().markers.size(), 1U);
  const visualization_msgs::Marker& lines = markers.back().markers.front();
  EXPECT_EQ(lines.header.frame_id, scene::kFrame);
  EXPECT_GE(lines.points.size(), 20U);
  EXPECT_EQ(lines.points.size(), lines.colors.size());
  EXPECT_EQ(lines.points.front().z, 1.0);
}

TEST(Nodelet, KeepsTheRulesOfTheStream) {
  Stream stream("stream");
  ASSERT_TRUE(stream.connected());
  stream.sendPictures(10, 12);
  stream.sendPictures(11, 12);                       // the same stamp
  stream.sendPictures(9, 10);                        // late
  stream.send(scene::monoMessage(12, ros::Time()));  // no stamp
  stream.sendPictures(12, 13);
  ASSERT_TRUE(stream.receives(3));
  EXPECT_EQ(stream.lines[2].header.stamp, kStart + kPeriod * 12);
  EXPECT_EQ(stream.lines[2].epoch, stream.lines[0].epoch);
  EXPECT_EQ(stream.lines[2].image_count, 3U);
  EXPECT_EQ(stream.statistics[2].dropped_duplicate, 1U);
  EXPECT_EQ(stream.statistics[2].dropped_late, 1U);
  EXPECT_EQ(stream.statistics[2].dropped_zero, 1U);

  stream.sendPictures(100, 101);  // a gap
  ASSERT_TRUE(stream.receives(4));
  EXPECT_EQ(stream.lines[3].epoch, stream.lines[2].epoch + 1);
  EXPECT_EQ(stream.lines[3].image_count, 1U);

  const cv::Mat larger = scene::picture(101, 400, 300);
  stream.send(scene::messageOf(larger, encodings::MONO8, kStart + kPeriod * 101));
  ASSERT_TRUE(stream.receives(5));
  EXPECT_EQ(stream.lines[4].epoch, stream.lines[3].epoch + 1);
  EXPECT_EQ(stream.lines[4].width, 400U);

  stream.sendPictures(0, 4);  // the bag begins again: two images tell, the third one counts
  ASSERT_TRUE(stream.receives(7));
  EXPECT_EQ(stream.lines[5].epoch, stream.lines[4].epoch + 1);
  EXPECT_EQ(stream.lines[5].header.stamp, kStart + kPeriod * 2);
  EXPECT_EQ(stream.lines[6].image_count, 2U);
  EXPECT_TRUE(manager_log->holds({"/stream/image", "dropped", "no stamp"}));
  ASSERT_TRUE(waitFor([&] { return stream.diagnostics["images tracked"] == "7"; }));
  EXPECT_EQ(stream.diagnostics["images dropped: late stamp"], "3");
  EXPECT_EQ(stream.diagnostics["images dropped: duplicate stamp"], "1");
  EXPECT_EQ(stream.diagnostics["images dropped: zero stamp"], "1");
}

TEST(Nodelet, TakesEveryEncodingAndSurvivesOthers) {
  Stream stream("encodings");
  ASSERT_TRUE(stream.connected());
  int image = 0;
  const auto send = [&](const std::string& encoding, const cv::Mat& pixels) {
    stream.send(scene::messageOf(pixels, encoding, kStart + kPeriod * image));
    ++image;
  };
  const auto coloured = [&](int code) {
    cv::Mat colour;
    cv::cvtColor(scene::picture(image), colour, code);
    return colour;
  };
  cv::Mat wide;
  send(encodings::MONO8, scene::picture(image));
  send(encodings::TYPE_8UC1, scene::picture(image));
  scene::picture(image).convertTo(wide, CV_16U, 256.0);
  send(encodings::MONO16, wide);
  scene::picture(image).convertTo(wide, CV_16U, 256.0);
  send(encodings::TYPE_16UC1, wide);
  send(encodings::BGR8, coloured(cv::COLOR_GRAY2BGR));
  send(encodings::RGB8, coloured(cv::COLOR_GRAY2RGB));
  send(encodings::BGRA8, coloured(cv::COLOR_GRAY2BGRA));
  send(encodings::RGBA8, coloured(cv::COLOR_GRAY2RGBA));
  send(encodings::BAYER_RGGB8, scene::picture(image));
  ASSERT_TRUE(stream.receives(9));
  expectContiguousIds(stream.lines);
  // The gray values of a colour image are those of the picture, so its lines go on.
  EXPECT_EQ(stream.lines[7].epoch, stream.lines[0].epoch);
  EXPECT_GE(stream.lines[7].lines.front().age, 8U);

  const std::size_t before = stream.lines.size();
  send(encodings::TYPE_32FC1, cv::Mat(scene::kHeight, scene::kWidth, CV_32FC1, cv::Scalar(0)));
  send(encodings::TYPE_32FC1, cv::Mat(scene::kHeight, scene::kWidth, CV_32FC1, cv::Scalar(0)));
  sensor_msgs::Image broken = scene::monoMessage(image, kStart + kPeriod * image);
  broken.data.resize(broken.data.size() / 2);
  stream.send(broken);
  send(encodings::MONO8, scene::picture(image));
  ASSERT_TRUE(stream.receives(before + 1));
  EXPECT_TRUE(manager_log->holds({"/encodings/image", "32FC1", "mono8"}));
  EXPECT_EQ(manager_log->count({"32FC1"}), 1);
  ASSERT_TRUE(waitFor([&] { return stream.diagnostics["images dropped: unreadable"] == "3"; }));
}

TEST(Nodelet, StartsAnEpochWhenItIsReset) {
  Stream stream("reset");
  ASSERT_TRUE(stream.connected());
  stream.sendPictures(0, 5);
  ASSERT_TRUE(stream.receives(5));
  std_srvs::Trigger reset;
  ASSERT_TRUE(ros::service::call("/reset/reset", reset));
  EXPECT_TRUE(reset.response.success);
  EXPECT_EQ(reset.response.message.rfind(std::to_string(stream.lines.back().lines.size()) + " tracks", 0), 0U)
      << reset.response.message;
  stream.sendPictures(5, 7);
  ASSERT_TRUE(stream.receives(7));
  EXPECT_EQ(stream.lines[5].epoch, stream.lines[4].epoch + 1);
  EXPECT_EQ(stream.lines[5].image_count, 1U);
  ASSERT_FALSE(stream.lines[5].lines.empty());
  for (const Line& line : stream.lines[5].lines) EXPECT_EQ(line.age, 1U);
}

TEST(Nodelet, TakesTheCalibrationWhenItComes) {
  Stream stream("calibration");
  ASSERT_TRUE(stream.connected());
  stream.sendPictures(0, 25);
  ASSERT_TRUE(stream.receives(25));
  ASSERT_FALSE(stream.lines[24].lines.empty());
  EXPECT_TRUE(std::isnan(stream.lines[24].lines[0].start_normalized[0]));
  EXPECT_TRUE(manager_log->holds({"/calibration/camera_info", "no camera_info after"}));

  stream.send(scene::cameraInfo(kStart));
  int sent = 25;
  ASSERT_TRUE(waitFor([&] {
    if (static_cast<int>(stream.lines.size()) == sent) stream.sendPictures(sent, sent + 1), ++sent;
    return !std::isnan(stream.lines.back().lines.at(0).start_normalized[0]);
  }));
  const Line& line = stream.lines.back().lines[0];
  EXPECT_NEAR(line.start_normalized[0], (line.start_px[0] - scene::kWidth / 2.0) / scene::kFocal, 1e-6);
  EXPECT_NEAR(line.start_normalized[1], (line.start_px[1] - scene::kHeight / 2.0) / scene::kFocal, 1e-6);
  EXPECT_GT(line.age, 25U);
  EXPECT_EQ(manager_log->count({"/calibration/camera_info", "no camera_info after"}), 1);

  sensor_msgs::CameraInfo other = scene::cameraInfo(kStart);
  other.width = 2 * scene::kWidth;
  stream.send(other);
  ASSERT_TRUE(waitFor([&] {
    if (static_cast<int>(stream.lines.size()) == sent) stream.sendPictures(sent, sent + 1), ++sent;
    return std::isnan(stream.lines.back().lines.at(0).start_normalized[0]);
  }));
  EXPECT_TRUE(manager_log->holds({"/calibration/camera_info", "640x240", "320x240"}));
}

TEST(Nodelet, ThinsOnlyTheMessages) {
  Stream stream("thinned");
  ASSERT_TRUE(stream.connected());
  stream.sendPictures(0, 60);
  ASSERT_TRUE(stream.receives(15));
  waitFor([] { return false; }, 0.5);
  ASSERT_EQ(stream.lines.size(), 15U);  // 60 images at 20 Hz, 5 Hz asked for
  for (std::size_t i = 0; i < stream.lines.size(); ++i) {
    EXPECT_EQ(stream.lines[i].image_count, 4 * i + 1);
    EXPECT_EQ(stream.lines[i].header.seq, i);
  }
  expectContiguousIds(stream.lines);
  EXPECT_EQ(stream.lines.back().lines.front().age, 57U);
}

TEST(Nodelet, CountsTheImagesThatNewerOnesReplace) {
  Stream stream("flooded");
  ASSERT_TRUE(stream.connected());
  const cv::Mat large = scene::picture(0, 1600, 1200);
  std::vector<sensor_msgs::Image> images;
  for (int i = 0; i < 40; ++i) {
    images.push_back(scene::messageOf(large, encodings::MONO8, kStart + kPeriod * (i + 1)));
  }
  stream.send(images.front());
  ASSERT_TRUE(stream.receives(1));
  for (std::size_t i = 1; i < images.size(); ++i) stream.send(images[i]);
  // The newest image always has its turn.
  const ros::Time newest = kStart + kPeriod * 40;
  ASSERT_TRUE(waitFor([&] {
    return stream.lines.back().header.stamp == newest && stream.statistics.back().header.stamp == newest;
  }));
  const int count = stream.diagnostics_count;
  ASSERT_TRUE(waitFor([&] { return stream.diagnostics_count > count + 1; }));
  const int received = std::stoi(stream.diagnostics["images received"]);
  const int dropped = std::stoi(stream.diagnostics["images dropped: queue"]);
  EXPECT_EQ(received, static_cast<int>(stream.lines.size()) + dropped);
  EXPECT_GT(dropped, 0);
  EXPECT_LE(stream.statistics.back().dropped_queue, static_cast<std::uint32_t>(dropped));
  EXPECT_GT(stream.statistics.back().dropped_queue, 0U);
}

TEST(Nodelet, TakesTheMotionFromAnOdometryWhereItIsAskedFor) {
  Stream stream("driven");
  ASSERT_TRUE(stream.connected());
  ros::NodeHandle node;
  ros::Publisher odometry = node.advertise<nav_msgs::Odometry>("/driven/odometry", 1000);
  ASSERT_TRUE(waitFor([&] { return odometry.getNumSubscribers() == 1; }));
  stream.send(scene::cameraInfo(kStart));
  ASSERT_TRUE(waitFor([&] { return stream.diagnostics["calibration"].rfind("plumb_bob", 0) == 0; }));
  for (int i = 0; i < 10; ++i) {
    nav_msgs::Odometry message;
    message.header.stamp = kStart + kPeriod * i;
    message.header.frame_id = "odom";
    message.child_frame_id = "base_link";
    message.pose.pose.position.x = 0.002 * i;
    message.pose.pose.orientation.w = 1.0;
    odometry.publish(message);
    stream.send(scene::monoMessage(i, message.header.stamp));
  }
  ASSERT_TRUE(stream.receives(10));
  const auto uses = std::count_if(stream.statistics.begin(), stream.statistics.end(),
                                  [](const TrackingStatistics& s) { return s.prior == "odometry"; });
  EXPECT_GE(uses, 8);
  EXPECT_TRUE(waitFor([&] { return stream.diagnostics["odometry"] == "/driven/odometry"; }))
      << stream.diagnostics["odometry"];
  EXPECT_EQ(stream.diagnostics["imu"], "not asked for");
}

TEST(Nodelet, LosesNoImageForWantOfAnImuThatIsOutOfStepAndTakesItBack) {
  Stream stream("imu_behind");
  ASSERT_TRUE(stream.connected());
  ros::NodeHandle node;
  ros::Publisher imu = node.advertise<sensor_msgs::Imu>("/imu_behind/imu", 1000);
  ASSERT_TRUE(waitFor([&] { return imu.getNumSubscribers() == 1; }));
  // Faster than images that each wait for imu_wait, which is 2 s here.
  ros::WallRate rate(15.0);
  int image = 0;
  const auto fly = [&](int images, double imu_behind_s) {
    for (const int end = image + images; image < end; ++image) {
      const ros::Time stamp = kStart + kPeriod * image;
      sensor_msgs::Imu message;
      message.header.frame_id = "imu";
      message.header.stamp = stamp - ros::Duration(imu_behind_s);
      imu.publish(message);
      stream.send(scene::monoMessage(image, stamp));
      ros::spinOnce();
      rate.sleep();
    }
  };
  fly(100, 900.0);
  ASSERT_TRUE(stream.receives(100)) << stream.lines.size() << " images were tracked, "
                                    << stream.statistics.size() << " statistics came, the first lines are of "
                                    << stream.lines.front().header.stamp << ", dropped by the queue: "
                                    << stream.diagnostics["images dropped: queue"];
  EXPECT_TRUE(manager_log->holds({"/imu_behind/imu is out of step", "s behind the image"}));
  EXPECT_TRUE(waitFor([&] {
    return stream.diagnostics["imu"].rfind("/imu_behind/imu, out of step: its newest", 0) == 0;
  })) << stream.diagnostics["imu"];
  fly(40, 0.0);
  ASSERT_TRUE(stream.receives(140)) << stream.lines.size() << " images were tracked";
  EXPECT_TRUE(manager_log->holds({"/imu_behind/imu is in step again"}));
  EXPECT_TRUE(waitFor([&] { return stream.diagnostics["imu"] == "/imu_behind/imu"; }))
      << stream.diagnostics["imu"];
  EXPECT_EQ(manager_log->count({"/imu_behind/imu is out of step"}), 1);
}

TEST(Nodelet, TellsWhichTopicsHaveImagesWhenItsOwnHasNone) {
  EXPECT_TRUE(manager_log->holds({"no image for", "/nobody/image (publishers: 0)", "/plain/debug_image"}));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_test");
  tet_line_tracker::ManagerLog log;
  tet_line_tracker::manager_log = &log;
  return RUN_ALL_TESTS();
}
