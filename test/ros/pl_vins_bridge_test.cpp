#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud.h>

#include "../../src/tools/pl_vins_contract.h"
#include "tet_line_tracker/LineArray.h"
#include "wait_for.h"

namespace tet_line_tracker {
namespace {

/// Tracker, point tracker and estimator around the bridge.
class Bridge : public ::testing::Test {
 protected:
  void SetUp() override {
    lines_ = node_.advertise<LineArray>("/tracker/lines", 1000);
    points_ = node_.advertise<sensor_msgs::PointCloud>("/feature_tracker/feature", 1000);
    received_ = node_.subscribe<sensor_msgs::PointCloud>(
        "/linefeature_tracker/linefeature", 2000, [this](const sensor_msgs::PointCloud::ConstPtr& message) {
          contract_.addLines(*message);
          stamps_.push_back(message->header.stamp);
          with_lines_ += message->points.empty() ? 0 : 1;
        });
    gated_ = node_.subscribe<sensor_msgs::PointCloud>(
        "/gated/features", 2000, [this](const sensor_msgs::PointCloud::ConstPtr& message) {
          gated_channels_.insert(message->channels.size());
          gated_stamps_.push_back(message->header.stamp);
        });
    // Both bridges live in one process, which counts as one subscriber of their common topic.
    ASSERT_TRUE(waitFor(
        [this] {
          return lines_.getNumSubscribers() == 1 && points_.getNumSubscribers() == 1 &&
                 received_.getNumPublishers() == 1 && gated_.getNumPublishers() == 1;
        },
        30.0));
    waitFor([] { return false; }, 0.5);  // the second bridge subscribes just after it advertises
  }

  LineArray image(int index) const {
    LineArray array;
    array.header.stamp = ros::Time(1000.0 + 0.05 * index);
    array.epoch = index < 120 ? 0 : (index < 200 ? 1 : 2);
    const int first = index < 120 ? 0 : (index < 200 ? 120 : 200);
    array.image_count = static_cast<std::uint64_t>(index - first) + 1;
    for (int k = 0; k < 20; ++k) {
      Line line;
      // Line k lives for 30 images, from a first image of its own.
      const int lived = (index - first + 7 * k) % 30;
      line.id = static_cast<std::uint64_t>((index - first + 7 * k) / 30 * 20 + k);
      line.age = static_cast<std::uint32_t>(std::min(lived, index - first)) + 1;
      line.start_normalized = {0.05 * k, -0.2};
      line.end_normalized = {0.05 * k, 0.2};
      array.lines.push_back(line);
    }
    return array;
  }

  void publishPoints(const ros::Time& stamp) {
    sensor_msgs::PointCloud points;
    points.header.stamp = stamp;
    contract_.addPoints(stamp);
    asked_.push_back(stamp);
    points_.publish(points);
  }

  ros::NodeHandle node_;
  ros::Publisher lines_, points_;
  PlVinsContract contract_;
  std::vector<ros::Time> asked_, stamps_, gated_stamps_;
  std::set<std::size_t> gated_channels_;
  std::size_t with_lines_{0};
  ros::Subscriber received_, gated_;
};

TEST_F(Bridge, BreaksNoRuleWhateverIsDroppedLateOrOutOfOrder) {
  // 15 s of images at 20 Hz, sent at four times that rate; points at 10 Hz; two resets.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::multimap<int, LineArray> later;
  constexpr int kImages = 300;
  for (int i = 0; i < kImages + 40; ++i) {
    if (i < kImages) {
      const double fate = uniform(random);
      // 5 % are dropped, 10 % come up to 0.1 s too late or never in time, 5 % change places with the next.
      if (fate > 0.05)
        later.emplace(i + (fate < 0.15  ? 1 + static_cast<int>(20 * uniform(random))
                           : fate < 0.2 ? 2
                                        : 0),
                      image(i));
      if (i % 2 == 0) publishPoints(image(i).header.stamp);
    }
    for (auto due = later.begin(); due != later.end() && due->first <= i; due = later.erase(due)) {
      lines_.publish(due->second);
    }
    ros::WallDuration(0.0125).sleep();
    ros::spinOnce();
  }
  EXPECT_TRUE(waitFor([this] { return stamps_.size() >= asked_.size(); }, 10.0));
  EXPECT_EQ(stamps_, asked_);
  contract_.finish();
  for (const ContractFault& fault : contract_.takeFaults()) {
    ADD_FAILURE() << nameOf(fault.rule) << " " << fault.stamp << " id " << fault.id << " " << fault.text;
  }
  EXPECT_EQ(contract_.pairs(), 150U);
  EXPECT_GT(with_lines_, 110U);
  EXPECT_GT(contract_.emptyMessages(), 3U);

  // The other bridge follows no points: about every second image, always forward.
  EXPECT_GT(gated_stamps_.size(), 100U);
  EXPECT_TRUE(std::is_sorted(gated_stamps_.begin(), gated_stamps_.end()));
  EXPECT_EQ(gated_channels_, std::set<std::size_t>{13});
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pl_vins_bridge_test");
  return RUN_ALL_TESTS();
}
