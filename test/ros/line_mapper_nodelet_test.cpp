#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include "tet_line_tracker/Line3DArray.h"
#include "tet_line_tracker/LineArray.h"
#include "wait_for.h"

namespace tet_line_tracker {
namespace {

/// A camera that moves along x and looks along z at a vertical line 2 m ahead.
class LineMapperNodelet : public ::testing::Test {
 protected:
  void SetUp() override {
    lines_ = node_.advertise<LineArray>("/tracker/lines", 100);
    tf_ = node_.advertise<tf2_msgs::TFMessage>("/tf", 100);
    map_subscriber_ = node_.subscribe<Line3DArray>("/line_mapper/lines", 10,
                                                   [this](const Line3DArray::ConstPtr& map) { map_ = *map; });
    marker_subscriber_ = node_.subscribe<visualization_msgs::Marker>(
        "/line_mapper/markers", 10, [this](const visualization_msgs::Marker::ConstPtr& marker) {
          marker_points_ = marker->points.size();
        });
    log_ =
        node_.subscribe<rosgraph_msgs::Log>("/rosout", 100, [this](const rosgraph_msgs::Log::ConstPtr& log) {
          if (log->msg.find("no pose of") != std::string::npos) warning_ = log->msg;
        });
    ASSERT_TRUE(waitFor([this] {
      return lines_.getNumSubscribers() == 1 && tf_.getNumSubscribers() == 1 &&
             map_subscriber_.getNumPublishers() == 1 && log_.getNumPublishers() > 0;
    }));
  }

  static ros::Time stampOf(int image) { return ros::Time(500.0 + 0.05 * image); }

  void publishPose(int image) {
    tf2_msgs::TFMessage message;
    geometry_msgs::TransformStamped& pose = message.transforms.emplace_back();
    pose.header.stamp = stampOf(image);
    pose.header.frame_id = "world";
    pose.child_frame_id = "cam0";
    pose.transform.translation.x = 0.05 * image;
    pose.transform.rotation.w = 1.0;
    tf_.publish(message);
  }

  void publishLines(int image, const std::string& frame = "cam0") {
    LineArray array;
    array.header.stamp = stampOf(image);
    array.header.frame_id = frame;
    array.image_count = static_cast<std::uint64_t>(image) + 1;
    Line line;
    line.age = static_cast<std::uint32_t>(image) + 1;
    const double x = (0.5 - 0.05 * image) / 2.0;
    line.start_normalized = {x, -0.25};
    line.end_normalized = {x, 0.25};
    line.start_px = {static_cast<float>(400.0 * x), -100.0F};
    line.end_px = {static_cast<float>(400.0 * x), 100.0F};
    line.sigma_px = 0.2F;
    array.lines.push_back(line);
    lines_.publish(array);
  }

  ros::NodeHandle node_;
  ros::Publisher lines_, tf_;
  Line3DArray map_;
  std::size_t marker_points_{0};
  std::string warning_;
  ros::Subscriber map_subscriber_, marker_subscriber_, log_;
};

TEST_F(LineMapperNodelet, MapsLinesAlsoWhenThePoseComesLaterAndSaysWhichFrameIsMissing) {
  for (int i = 0; i < 20; ++i) {
    publishLines(i);
    ros::WallDuration(0.02).sleep();
    publishPose(i);
  }
  ASSERT_TRUE(waitFor([this] { return map_.lines.size() == 1 && map_.lines[0].views == 20; }));
  EXPECT_EQ(map_.header.frame_id, "world");
  EXPECT_EQ(map_.header.stamp, stampOf(19));
  EXPECT_NEAR(map_.lines[0].start.x, 0.5, 1e-6);
  EXPECT_NEAR(map_.lines[0].start.y, -0.5, 1e-6);
  EXPECT_NEAR(map_.lines[0].end.z, 2.0, 1e-6);
  EXPECT_FALSE(map_.lines[0].finished);
  EXPECT_TRUE(waitFor([this] { return marker_points_ == 2; }));

  publishLines(20, "cam7");
  ASSERT_TRUE(waitFor([this] { return !warning_.empty(); }));
  EXPECT_NE(warning_.find("cam7"), std::string::npos) << warning_;

  std_srvs::Trigger trigger;
  ASSERT_TRUE(ros::service::call("/line_mapper/reset", trigger));
  EXPECT_TRUE(waitFor([this] { return map_.lines.empty(); }));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "line_mapper_nodelet_test");
  return RUN_ALL_TESTS();
}
