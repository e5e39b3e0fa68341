/// What a driver may send: the tracker goes on, says what it saw, and loses nothing else.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <unistd.h>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "managed_nodelet.h"
#include "node_stream.h"

namespace tet_line_tracker {
namespace {

namespace scene = synthetic_scene;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A tracker that drops no image because the machine is busy.
class NodeletFaults : public ::testing::Test {
 protected:
  void start(const std::string& name) {
    ros::param::set("/" + name + "/queue_size", 1000);
    nodelet_ = std::make_unique<ManagedNodelet>(name);
    ASSERT_TRUE(nodelet_->isLoaded());
    stream_ = std::make_unique<Stream>(name);
    ASSERT_TRUE(stream_->connected());
  }
  void TearDown() override { EXPECT_TRUE(ManagedNodelet::managerLives()); }

  void sendNext() {
    stream_->sendPictures(sent_, sent_ + 1);
    ++sent_;
  }
  /// Sends pictures until one has lines whose ends are normalised, or not.
  bool becomesNormalized(bool normalized) {
    return waitFor([&] {
      if (static_cast<int>(stream_->lines.size()) == sent_) sendNext();
      if (stream_->lines.empty() || stream_->lines.back().lines.empty()) return false;
      return std::isfinite(stream_->lines.back().lines[0].start_normalized[0]) == normalized;
    });
  }

  ManagerLog log_;
  std::unique_ptr<ManagedNodelet> nodelet_;
  std::unique_ptr<Stream> stream_;
  int sent_{0};
};

sensor_msgs::CameraInfo calibration(const std::string& model, const std::vector<double>& distortion,
                                    double focal_length = scene::kFocal) {
  sensor_msgs::CameraInfo info = scene::cameraInfo(kStart);
  info.distortion_model = model;
  info.D = distortion;
  info.K[0] = info.K[4] = focal_length;
  return info;
}

TEST_F(NodeletFaults, EveryAbsurdCalibrationIsRefusedWithASentenceAndTrackingGoesOn) {
  start("absurd_calibration");
  const std::vector<double> intrinsics{458.654, 457.296, 367.215, 248.375};
  std::vector<sensor_msgs::CameraInfo> absurd{
      calibration("plumb_bob", intrinsics),
      calibration("plumb_bob", {100, 100, 100, 100}),
      calibration("plumb_bob", {kNan, 0, 0, 0}),
      calibration("plumb_bob", {0, 0, 0, 0, 0}, 1e7),
      calibration("plumb_bob", {0, 0, 0, 0, 0}, -250.0),
      calibration("plumb_bob", {0, 0, 0, 0, 0}, kInfinity),
      calibration("plumb_bob", {0.1}),
      calibration("plumb_bob", std::vector<double>(100000, 0.1)),
      calibration("rational_polynomial", {458, 457, 367, 248, 1, 1, 1, 1}),
      calibration("mei", intrinsics),
      calibration("equidistant", {1e30, 1e30, 1e30, 1e30}),
      calibration(std::string(100000, 'x'), {}),
  };
  absurd.push_back(scene::cameraInfo(kStart));
  absurd.back().K[2] = 1e9;
  absurd.push_back(scene::cameraInfo(kStart));
  absurd.back().width = absurd.back().height = 4294967295U;
  absurd.push_back(scene::cameraInfo(kStart));
  absurd.back().binning_x = 4294967295U;
  absurd.push_back(scene::cameraInfo(kStart));
  absurd.back().roi.x_offset = absurd.back().roi.width = 4294967295U;
  for (std::size_t i = 0; i < absurd.size(); ++i) {
    stream_->send(scene::cameraInfo(kStart));
    ASSERT_TRUE(becomesNormalized(true)) << "before " << i;
    stream_->send(absurd[i]);
    ASSERT_TRUE(becomesNormalized(false)) << "calibration " << i;
  }
  EXPECT_TRUE(log_.holds({"/absurd_calibration/camera_info: camera_info cannot be used", "458.654",
                          "normalised endpoints are NaN"}));
  EXPECT_TRUE(stream_->receives(static_cast<std::size_t>(sent_))) << stream_->lines.size();
  EXPECT_EQ(stream_->lines.back().epoch, stream_->lines.front().epoch);
  EXPECT_TRUE(waitFor([&] {
    return stream_->summary.find("not calibrated") != std::string::npos &&
           stream_->diagnostics["calibration"].rfind("camera_info cannot be used", 0) == 0;
  })) << stream_->summary;
}

TEST_F(NodeletFaults, ACalibrationOfTheFullImageIsTakenThroughBinningAndRegionOfInterest) {
  start("binned");
  sensor_msgs::CameraInfo info = scene::cameraInfo(kStart);
  info.width = 2 * scene::kWidth + 50;
  info.height = 2 * scene::kHeight;
  info.binning_x = info.binning_y = 2;
  info.roi.x_offset = 50;
  info.roi.width = 2 * scene::kWidth;
  info.roi.height = 2 * scene::kHeight;
  info.K = {2 * scene::kFocal, 0, scene::kWidth + 50.0, 0, 2 * scene::kFocal, 1.0 * scene::kHeight, 0, 0, 1};
  stream_->send(info);
  ASSERT_TRUE(becomesNormalized(true));
  const Line& line = stream_->lines.back().lines[0];
  EXPECT_NEAR(line.start_normalized[0], (line.start_px[0] - scene::kWidth / 2.0) / scene::kFocal, 1e-6);
  EXPECT_NEAR(line.end_normalized[1], (line.end_px[1] - scene::kHeight / 2.0) / scene::kFocal, 1e-6);
  EXPECT_TRUE(waitFor([&] {
    return stream_->diagnostics["calibration"] ==
           "plumb_bob, 320x240 (690x480, region of interest 640x480 at (50, 0), binning 2x2)";
  })) << stream_->diagnostics["calibration"];
}

TEST_F(NodeletFaults, ImuMessagesThatNoGyroscopeSendsCostNoImageAndNoLine) {
  ros::param::set("/absurd_imu/imu_rotation", "0 0 0 1");
  start("absurd_imu");
  ros::NodeHandle node;
  ros::Publisher imu = node.advertise<sensor_msgs::Imu>("/absurd_imu/imu", 1000);
  ASSERT_TRUE(waitFor([&] { return imu.getNumSubscribers() == 1; }));
  stream_->send(scene::cameraInfo(kStart));
  const std::vector<double> rates{1e300, 1e160, kNan, kInfinity, -1e300};
  ros::WallRate pace(100.0);
  constexpr int kImages = 60;
  for (; sent_ < kImages; sendNext()) {
    sensor_msgs::Imu message;
    message.header.frame_id = "imu";
    for (int part = 0; part < 2; ++part) {
      message.header.stamp = kStart + kPeriod * (sent_ + 0.5 * part);
      const double rate =
          sent_ >= 20 && sent_ < 30 && part == 1 ? rates[static_cast<std::size_t>(sent_) % 5] : 0.0;
      message.angular_velocity.x = message.angular_velocity.z = rate;
      imu.publish(message);
    }
    pace.sleep();
  }
  ASSERT_TRUE(stream_->receives(kImages));
  // The oldest line is from the first image: none of those messages took all lines away.
  EXPECT_EQ(stream_->lines.back().lines.at(0).age, static_cast<std::uint32_t>(kImages));
  for (const LineArray& array : stream_->lines) {
    EXPECT_GE(array.lines.size(), 10U) << array.image_count;
    for (const Line& line : array.lines) EXPECT_TRUE(std::isfinite(line.start_px[0] + line.end_px[1]));
  }
  expectContiguousIds(stream_->lines);
}

TEST_F(NodeletFaults, FramesWithoutANameOrWithAnyNameCostNoImage) {
  start("frames");  // the extrinsic is asked of tf, by these names
  ros::NodeHandle node;
  ros::Publisher imu = node.advertise<sensor_msgs::Imu>("/frames/imu", 1000);
  ASSERT_TRUE(waitFor([&] { return imu.getNumSubscribers() == 1; }));
  const std::vector<std::string> imus{"", "/", "//a//b", "imu imu", std::string(100000, 'x'), "\xff\n%s%n"};
  const std::vector<std::string> cameras{"cam", "//", "/c/", "%s%n", std::string(100000, 'y'), "\xfe\t"};
  for (std::size_t k = 0; k < imus.size(); ++k) {
    for (int i = 0; i < 5; ++i, ++sent_) {
      sensor_msgs::Imu message;
      message.header.stamp = kStart + kPeriod * (sent_ + 1);
      message.header.frame_id = imus[k];
      imu.publish(message);
      sensor_msgs::Image image = scene::monoMessage(sent_, kStart + kPeriod * sent_);
      image.header.frame_id = cameras[k];
      stream_->send(image);
    }
  }
  ASSERT_TRUE(stream_->receives(static_cast<std::size_t>(sent_))) << stream_->lines.size();
  EXPECT_EQ(stream_->lines.back().header.frame_id, cameras.back());
  EXPECT_TRUE(log_.holds({"/frames/imu", "no transform leads from its frame"}));
}

TEST_F(NodeletFaults, AMaskOfAnotherSizeIsToldAndLinesAreTrackedInTheWholeImage) {
  const std::string path =
      std::filesystem::temp_directory_path() / ("nodelet_faults_" + std::to_string(getpid()) + ".png");
  ASSERT_TRUE(cv::imwrite(path, cv::Mat(10, 20, CV_8UC1, cv::Scalar(0))));
  ros::param::set("/wrong_mask/mask", path);
  start("wrong_mask");
  for (int i = 0; i < 5; ++i) sendNext();
  ASSERT_TRUE(stream_->receives(5));
  unlink(path.c_str());
  EXPECT_GE(stream_->lines.back().lines.size(), 10U);
  EXPECT_TRUE(log_.holds({path, "the mask is 20x10, the images have 320x240", "in the whole image"}));
  EXPECT_EQ(log_.count({path, "the mask is"}), 1) << "told once a minute";
}

TEST_F(NodeletFaults, OneImageWithAStampFarAheadCostsThoseThatTellItWasWrong) {
  start("future");
  for (int i = 0; i < 5; ++i) sendNext();
  stream_->send(scene::monoMessage(5, ros::Time(4294967295U, 999999999U)));
  for (int i = 0; i < 10; ++i) sendNext();
  // The stray image is an epoch of its own; two late images tell that stamps have gone back.
  ASSERT_TRUE(stream_->receives(14)) << stream_->lines.size();
  EXPECT_EQ(stream_->lines[5].header.stamp, ros::Time(4294967295U, 999999999U));
  EXPECT_EQ(stream_->lines.back().header.stamp, kStart + kPeriod * 14);
  EXPECT_EQ(stream_->lines.back().epoch, stream_->lines.front().epoch + 2);
  EXPECT_TRUE(waitFor([&] { return stream_->diagnostics["images dropped: late stamp"] == "2"; }));
  EXPECT_TRUE(log_.holds({"/future/image", "dropped", "its stamp is before the last one"}));
}

TEST_F(NodeletFaults, SizesThatChangeWithEveryImageAreEpochsAndNothingElse) {
  start("sizes");
  const std::vector<cv::Size> sizes{{1, 1}, {1, 2000}, {2000, 1}, {320, 240}, {7, 7}, {640, 480}};
  for (int i = 0; i < 36; ++i) {
    const cv::Size size = sizes[static_cast<std::size_t>(i) % sizes.size()];
    const cv::Mat picture = size.width < 80 || size.height < 80 ? cv::Mat(size, CV_8UC1, cv::Scalar(i))
                                                                : scene::picture(i, size.width, size.height);
    stream_->send(scene::messageOf(picture, "mono8", kStart + kPeriod * i));
  }
  ASSERT_TRUE(stream_->receives(36)) << stream_->lines.size();
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(stream_->lines[i].epoch, i + stream_->lines[0].epoch);
    EXPECT_EQ(stream_->lines[i].width, static_cast<std::uint32_t>(sizes[i % sizes.size()].width));
  }
  EXPECT_TRUE(log_.holds({"epoch", "begins at stamp"}));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_faults_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
