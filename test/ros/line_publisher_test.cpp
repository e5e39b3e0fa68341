#include "line_publisher.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/TrackingStatistics.h"
#include "wait_for.h"

namespace tet_line_tracker {
namespace {

/// Image i of a 20 Hz camera with one line.
LineFrame frameOf(int i, std::uint32_t epoch = 1) {
  LineFrame frame;
  frame.stamp_ns = 1000000000000 + 50000000LL * i;
  frame.epoch = epoch;
  frame.image_count = static_cast<std::uint64_t>(i) + 1;
  frame.width = 32;
  frame.height = 24;
  TrackedLine line;
  line.id = 7;
  line.age = static_cast<std::uint32_t>(i) + 1;
  line.segment = {{2.0F, 3.0F}, {20.0F, 15.0F}};
  line.start_normalized = {0.1, 0.2};
  line.end_normalized = {0.3, 0.4};
  frame.lines.push_back(line);
  return frame;
}

/// A publisher below /NAME and what is heard of it.
class LinePublisherTest : public testing::Test {
 protected:
  void listenToLines() {
    lines_in_ = node_.subscribe<LineArray>(
        "lines", 100, [this](const LineArray::ConstPtr& message) { lines_.push_back(*message); });
    ASSERT_TRUE(waitFor([this] { return lines_in_.getNumPublishers() == 1; }));
  }
  bool publish(const LineFrame& frame, std::uint64_t replaced = 0) {
    return publisher_.publish(frame, "cam", gray_, replaced);
  }

  ros::NodeHandle node_{testing::UnitTest::GetInstance()->current_test_info()->name()};
  NodeParameters parameters_;
  const cv::Mat gray_{24, 32, CV_8UC1, cv::Scalar(90)};
  LinePublisher publisher_{node_, parameters_};
  std::vector<LineArray> lines_;
  ros::Subscriber lines_in_;
};

TEST_F(LinePublisherTest, PublishesLinesWithStampAndFrameOfTheImage) {
  listenToLines();
  EXPECT_TRUE(publish(frameOf(0)));
  EXPECT_TRUE(publish(frameOf(1)));
  ASSERT_TRUE(waitFor([this] { return lines_.size() == 2; }));
  EXPECT_EQ(lines_[1].header.stamp.toNSec(), 1000050000000U);
  EXPECT_EQ(lines_[1].header.frame_id, "cam");
  EXPECT_EQ(lines_[1].header.seq, 1U);
  ASSERT_EQ(lines_[1].lines.size(), 1U);
  EXPECT_EQ(lines_[1].lines[0].id, 7U);
}

TEST_F(LinePublisherTest, CountsStatisticsOfTheImagesInWhichSomebodyListened) {
  listenToLines();
  publish(frameOf(0));
  publish(frameOf(1));
  ASSERT_TRUE(waitFor([this] { return lines_.size() == 2; }));
  std::vector<TrackingStatistics> statistics;
  const ros::Subscriber in = node_.subscribe<TrackingStatistics>(
      "statistics", 100,
      [&](const TrackingStatistics::ConstPtr& message) { statistics.push_back(*message); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  publish(frameOf(2));
  ASSERT_TRUE(waitFor([&] { return statistics.size() == 1; }));
  EXPECT_EQ(statistics[0].header.seq, 0U);
  EXPECT_EQ(statistics[0].image_count, 3U);
}

TEST_F(LinePublisherTest, CountsReplacedImagesFromTheStartOfTheEpoch) {
  std::vector<TrackingStatistics> statistics;
  const ros::Subscriber in = node_.subscribe<TrackingStatistics>(
      "statistics", 100,
      [&](const TrackingStatistics::ConstPtr& message) { statistics.push_back(*message); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  publish(frameOf(0), 3);
  publish(frameOf(1), 5);
  publish(frameOf(2, 2), 9);
  publish(frameOf(3, 2), 10);
  ASSERT_TRUE(waitFor([&] { return statistics.size() == 4; }));
  EXPECT_EQ(statistics[0].dropped_queue, 0U);
  EXPECT_EQ(statistics[1].dropped_queue, 2U);
  EXPECT_EQ(statistics[2].dropped_queue, 0U);
  EXPECT_EQ(statistics[3].dropped_queue, 1U);
}

TEST_F(LinePublisherTest, PaintsTheImageWhileSomebodyLooks) {
  std::vector<sensor_msgs::Image> images;
  const ros::Subscriber in = node_.subscribe<sensor_msgs::Image>(
      "debug_image", 10, [&](const sensor_msgs::Image::ConstPtr& message) { images.push_back(*message); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  publish(frameOf(0));
  ASSERT_TRUE(waitFor([&] { return images.size() == 1; }));
  EXPECT_EQ(images[0].header.stamp.toNSec(), 1000000000000U);
  EXPECT_EQ(images[0].header.frame_id, "cam");
  EXPECT_EQ(images[0].encoding, sensor_msgs::image_encodings::BGR8);
  ASSERT_EQ(images[0].data.size(), 3U * 32U * 24U);
  EXPECT_EQ(images[0].data[0], 90);  // far from the line: the image itself
  const std::size_t on_line = 3 * (9 * 32 + 11);
  EXPECT_FALSE(images[0].data[on_line] == 90 && images[0].data[on_line + 1] == 90 &&
               images[0].data[on_line + 2] == 90);
}

TEST(LinePublisher, PaintsAtDebugImageRateFromTheStartAndAfterAChange) {
  ros::NodeHandle node("painted");
  NodeParameters parameters;
  parameters.debug_image_rate = 5.0;
  LinePublisher publisher(node, parameters);
  std::vector<std::uint64_t> stamps;
  const ros::Subscriber in = node.subscribe<sensor_msgs::Image>(
      "debug_image", 10,
      [&](const sensor_msgs::Image::ConstPtr& message) { stamps.push_back(message->header.stamp.toNSec()); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  const cv::Mat gray(24, 32, CV_8UC1, cv::Scalar(90));
  std::vector<std::uint64_t> expected;
  for (int i = 0; i < 10; ++i) {
    if (i == 8) {
      parameters.debug_image_rate = 10.0;
      publisher.setParameters(parameters);
    }
    EXPECT_TRUE(publisher.publish(frameOf(i), "cam", gray, 0));
    if (i != 0 && i != 4 && i != 8) continue;
    expected.push_back(static_cast<std::uint64_t>(frameOf(i).stamp_ns));
    ASSERT_TRUE(waitFor([&] { return stamps.size() == expected.size(); }));
  }
  publisher.publish(frameOf(10), "cam", gray, 0);
  expected.push_back(static_cast<std::uint64_t>(frameOf(10).stamp_ns));
  ASSERT_TRUE(waitFor([&] { return stamps.size() == expected.size(); }));
  EXPECT_EQ(stamps, expected);
}

TEST_F(LinePublisherTest, SendsMarkersOfTheNormalisedLines) {
  std::vector<visualization_msgs::MarkerArray> arrays;
  const ros::Subscriber in = node_.subscribe<visualization_msgs::MarkerArray>(
      "markers", 10,
      [&](const visualization_msgs::MarkerArray::ConstPtr& message) { arrays.push_back(*message); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  publish(frameOf(0));
  ASSERT_TRUE(waitFor([&] { return arrays.size() == 1; }));
  ASSERT_FALSE(arrays[0].markers.empty());
  ASSERT_EQ(arrays[0].markers.back().points.size(), 2U);
  EXPECT_NEAR(arrays[0].markers.back().points[1].x, 0.3, 1e-6);
}

TEST_F(LinePublisherTest, IdsOfMarkersComeAndGoWithTheParameter) {
  std::vector<visualization_msgs::MarkerArray> arrays;
  const ros::Subscriber in = node_.subscribe<visualization_msgs::MarkerArray>(
      "markers", 10,
      [&](const visualization_msgs::MarkerArray::ConstPtr& message) { arrays.push_back(*message); });
  ASSERT_TRUE(waitFor([&] { return in.getNumPublishers() == 1; }));
  const auto texts = [&](int i) {
    const std::size_t before = arrays.size();
    publish(frameOf(i));
    EXPECT_TRUE(waitFor([&] { return arrays.size() == before + 1; }));
    return std::count_if(arrays.back().markers.begin(), arrays.back().markers.end(), [](const auto& marker) {
      return marker.ns == "ids" && marker.action == visualization_msgs::Marker::ADD;
    });
  };
  NodeParameters parameters;
  parameters.marker_ids = false;
  publisher_.setParameters(parameters);
  EXPECT_EQ(texts(0), 0);
  parameters.marker_ids = true;
  publisher_.setParameters(parameters);
  EXPECT_EQ(texts(1), 1);
}

TEST(LinePublisher, AnotherRateHoldsFromTheNextImageOn) {
  ros::NodeHandle node("paced");
  NodeParameters parameters;
  LinePublisher publisher(node, parameters);
  const cv::Mat gray(24, 32, CV_8UC1, cv::Scalar(90));
  std::vector<bool> published;
  for (int i = 0; i < 9; ++i) {
    if (i == 2) parameters.publish_rate = 5.0;
    publisher.setParameters(parameters);
    published.push_back(publisher.publish(frameOf(i), "cam", gray, 0));
  }
  EXPECT_EQ(published, (std::vector<bool>{true, true, true, false, false, false, true, false, false}));
}

TEST(LinePublisher, LeavesOutImagesAbovePublishRateAndNeverTheFirstOfAnEpoch) {
  ros::NodeHandle node("thinned");
  NodeParameters parameters;
  parameters.publish_rate = 5.0;
  LinePublisher publisher(node, parameters);
  const cv::Mat gray(24, 32, CV_8UC1, cv::Scalar(90));
  std::vector<bool> published;
  for (int i = 0; i < 6; ++i) published.push_back(publisher.publish(frameOf(i), "cam", gray, 0));
  EXPECT_EQ(published, (std::vector<bool>{true, false, false, false, true, false}));
  EXPECT_TRUE(publisher.publish(frameOf(6, 2), "cam", gray, 0));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "line_publisher_test");
  ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
