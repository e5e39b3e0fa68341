#include "debug_image_publisher.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

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
  DebugImagePublisher publisher_{node_, plainStyle()};
  std::vector<sensor_msgs::Image::ConstPtr> seen_;
  ros::Subscriber in_;
};

TEST_F(DebugImagePublisherTest, PaintsThePixelsOfItsTimeWhateverBecomesOfTheImage) {
  look();
  cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(90));
  publisher_.publish(frameOf(0, gray), "cam", gray);
  gray.setTo(cv::Scalar(10));
  ASSERT_TRUE(waitFor([this] { return hasSeen(0); }));
  EXPECT_TRUE(
      std::all_of(seen_[0]->data.begin(), seen_[0]->data.end(), [](int value) { return value == 90; }));
}

TEST_F(DebugImagePublisherTest, ShowsTheNewestOfABurstThatIsTooFastToPaintAndKeepsTheOrder) {
  look();
  const cv::Mat gray(2160, 3840, CV_8UC1, cv::Scalar(90));
  constexpr int kBurst = 60;
  for (int i = 0; i < kBurst; ++i) publisher_.publish(frameOf(i, gray), "cam", gray);
  ASSERT_TRUE(waitFor([this] { return hasSeen(kBurst - 1); }));
  EXPECT_TRUE(std::is_sorted(seen_.begin(), seen_.end(), [](const auto& one, const auto& other) {
    return one->header.stamp < other->header.stamp;
  }));
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
  DebugImagePublisher other(node_, plainStyle());
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
