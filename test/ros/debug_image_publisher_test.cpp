#include "debug_image_publisher.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tet_line_tracker/camera/camera_model.h"
#include "wait_for.h"

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kFirst = 1000000000000;

/// Image i of a 20 Hz camera without lines.
LineFrame frameOf(int i, const cv::Mat& gray) {
  LineFrame frame;
  frame.stamp_ns = kFirst + 50000000LL * i;
  frame.epoch = 1;
  frame.image_count = static_cast<std::uint64_t>(i) + 1;
  frame.width = gray.cols;
  frame.height = gray.rows;
  return frame;
}

TrackPainter::Style plainStyle() {
  TrackPainter::Style style;
  style.scale = false;
  return style;
}

/// A publisher below /NAME and what is seen of it.
class DebugImagePublisherTest : public testing::Test {
 protected:
  void look() {
    in_ = node_.subscribe<sensor_msgs::Image>(
        "debug_image", 1000, [this](const sensor_msgs::Image::ConstPtr& image) { seen_.push_back(image); });
    ASSERT_TRUE(waitFor([this] { return in_.getNumPublishers() == 1; }));
  }
  bool hasSeen(int i) const {
    return std::any_of(seen_.begin(), seen_.end(), [i](const auto& image) {
      return image->header.stamp.toNSec() == static_cast<std::uint64_t>(kFirst + 50000000LL * i);
    });
  }

  ros::NodeHandle node_{testing::UnitTest::GetInstance()->current_test_info()->name()};
  DebugImagePublisher publisher_{node_, plainStyle(), 0.0};
  std::vector<sensor_msgs::Image::ConstPtr> seen_;
  ros::Subscriber in_;
};

TEST_F(DebugImagePublisherTest, PaintsThePixelsOfItsTimeWhateverBecomesOfTheImage) {
  look();
  // The painter is busy with the first one while the second one changes.
  const cv::Mat large(2160, 3840, CV_8UC1, cv::Scalar(90));
  publisher_.publish(frameOf(0, large), "cam", large);
  cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(90));
  publisher_.publish(frameOf(1, gray), "cam", gray);
  gray.setTo(cv::Scalar(10));
  ASSERT_TRUE(waitFor([this] { return hasSeen(1); }));
  const std::vector<std::uint8_t>& data = seen_.back()->data;
  EXPECT_EQ(data.size(), 3 * gray.total());
  EXPECT_TRUE(std::all_of(data.begin(), data.end(), [](int value) { return value == 90; }));
}

TEST_F(DebugImagePublisherTest, ShowsTheNewestOfABurstThatIsTooFastToPaintAndKeepsTheOrder) {
  look();
  const cv::Mat gray(2160, 3840, CV_8UC1, cv::Scalar(90));
  constexpr int kBurst = 60;
  for (int i = 0; i < kBurst; ++i) publisher_.publish(frameOf(i, gray), "cam", gray);
  ASSERT_TRUE(waitFor([this] { return hasSeen(kBurst - 1); }));
  EXPECT_LT(seen_.size(), static_cast<std::size_t>(kBurst));
  EXPECT_TRUE(std::is_sorted(seen_.begin(), seen_.end(), [](const auto& one, const auto& other) {
    return one->header.stamp < other->header.stamp;
  }));
}

TEST_F(DebugImagePublisherTest, PaintsNoMoreThanItsRateByTheStamps) {
  look();
  const cv::Mat gray(24, 32, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i <= 40; ++i) {
    publisher_.setRate(i < 20 ? 5.0 : 0.0);  // the same again begins nothing anew
    publisher_.publish(frameOf(i, gray), "cam", gray);
    // All that pass are painted: none waits for the next one.
    if (i % 4 == 0 || i > 20) {
      ASSERT_TRUE(waitFor([&] { return hasSeen(i); })) << i;
    }
  }
  EXPECT_EQ(seen_.size(), 5U + 21U);
}

TEST_F(DebugImagePublisherTest, PaintsLinesAsTheCameraBendsThem) {
  look();
  CameraCalibration calibration;
  calibration.fx = calibration.fy = 460.0;
  calibration.cx = 375.5;
  calibration.cy = 239.5;
  calibration.model = "plumb_bob";
  calibration.distortion = {-0.29, 0.08, 0.0, 0.0};
  const auto camera = makeCameraModel(calibration);
  const cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(90));
  LineFrame frame = frameOf(0, gray);
  TrackedLine line;
  line.segment = {{60.0F, 40.0F}, {700.0F, 40.0F}};
  frame.lines.push_back(line);
  const auto paintedBy = [&](std::shared_ptr<const CameraModel> lens) {
    TrackPainter painter(plainStyle());
    painter.setCamera(std::move(lens));
    cv::Mat bgr;
    painter.paint(gray, frame, bgr);
    return std::vector<std::uint8_t>(bgr.datastart, bgr.dataend);
  };
  publisher_.setCamera(camera);
  publisher_.publish(frame, "cam", gray);
  ASSERT_TRUE(waitFor([this] { return hasSeen(0); }));
  EXPECT_EQ(seen_[0]->data, paintedBy(camera));
  EXPECT_NE(seen_[0]->data, paintedBy(nullptr));
}

TEST_F(DebugImagePublisherTest, SurvivesAnImageThatCannotBePainted) {
  look();
  const cv::Mat gray(24, 32, CV_8UC1, cv::Scalar(90));
  publisher_.publish(frameOf(0, cv::Mat(10, 10, CV_8UC1)), "cam", gray);
  publisher_.publish(frameOf(1, gray), "cam", gray);
  ASSERT_TRUE(waitFor([this] { return hasSeen(1); }));
  EXPECT_FALSE(hasSeen(0));
}

TEST_F(DebugImagePublisherTest, EndsWhileImagesWait) {
  look();
  const cv::Mat gray(2160, 3840, CV_8UC1, cv::Scalar(90));
  DebugImagePublisher other(node_, plainStyle(), 0.0);
  for (int i = 0; i < 10; ++i) other.publish(frameOf(i, gray), "cam", gray);
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "debug_image_publisher_test");
  ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
