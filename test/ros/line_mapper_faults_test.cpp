/// Lines and poses that no tracker and no estimator sends: the map holds numbers, and is built again
/// afterwards.

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <limits>

#include "managed_nodelet.h"
#include "node_stream.h"
#include "tet_line_tracker/Line3DArray.h"

namespace tet_line_tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A camera that moves along x and looks along z at vertical lines 2 m ahead.
class LineMapperFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    lines_ = node_.advertise<LineArray>("/tracker/lines", 1000);
    tf_ = node_.advertise<tf2_msgs::TFMessage>("/tf", 1000);
    map_subscriber_ = node_.subscribe<Line3DArray>("/line_mapper/lines", 10,
                                                   [this](const Line3DArray::ConstPtr& map) { take(*map); });
    ASSERT_TRUE(waitFor([this] {
      return lines_.getNumSubscribers() == 1 && tf_.getNumSubscribers() == 1 &&
             map_subscriber_.getNumPublishers() == 1;
    }));
  }
  void TearDown() override { EXPECT_TRUE(ManagedNodelet::managerLives()); }

  void take(const Line3DArray& map) {
    map_ = map;
    for (const Line3D& line : map.lines) {
      const double sum = line.start.x + line.start.y + line.start.z + line.end.x + line.end.y + line.end.z;
      EXPECT_TRUE(std::isfinite(sum) && std::isfinite(line.sigma_start + line.sigma_end)) << line;
      EXPECT_TRUE(std::isfinite(line.reprojection_error + line.parallax + line.distance)) << line;
    }
  }
  geometry_msgs::TransformStamped pose() const {
    geometry_msgs::TransformStamped pose;
    pose.header.stamp = kStart + kPeriod * image_;
    pose.header.frame_id = "world";
    pose.child_frame_id = "cam0";
    pose.transform.translation.x = 0.05 * (image_ - first_);
    pose.transform.rotation.w = 1.0;
    return pose;
  }
  LineArray lines() const {
    LineArray array;
    array.header.stamp = kStart + kPeriod * image_;
    array.header.frame_id = "cam0";
    array.epoch = epoch_;
    array.image_count = static_cast<std::uint64_t>(image_) + 1;
    for (int k = 0; k < 3; ++k) {
      Line line;
      line.id = static_cast<std::uint64_t>(k);
      line.age = static_cast<std::uint32_t>(image_) + 1;
      const double x = (0.5 + 0.3 * k - 0.05 * (image_ - first_)) / 2.0;
      line.start_normalized = {x, -0.25};
      line.end_normalized = {x, 0.25};
      line.start_px = {static_cast<float>(400.0 * x), -100.0F};
      line.end_px = {static_cast<float>(400.0 * x), 100.0F};
      line.sigma_px = 0.2F;
      array.lines.push_back(line);
    }
    return array;
  }
  void send(const geometry_msgs::TransformStamped& pose, const LineArray& array) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(pose);
    tf_.publish(message);
    lines_.publish(array);
    ++image_;
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  /// Good images: three lines, each seen from these on.
  bool mapsAgain() {
    first_ = image_;
    ++epoch_;  // other tracks than those that saw the faults
    for (int i = 0; i < 20; ++i) send(pose(), lines());
    return waitFor([this] {
      return std::count_if(map_.lines.begin(), map_.lines.end(), [](const Line3D& line) {
               return !line.finished && std::abs(line.start.z - 2.0) < 1e-3;
             }) == 3;
    });
  }

  ManagerLog log_;
  ros::NodeHandle node_;
  ros::Publisher lines_, tf_;
  ros::Subscriber map_subscriber_;
  Line3DArray map_;
  int image_{0};
  std::uint32_t epoch_{0};
  int first_{0};  ///< image at which the camera is at its start
};

TEST_F(LineMapperFaults, LinesThatNoTrackerSendsLeaveTheMapFinite) {
  ASSERT_TRUE(mapsAgain());
  for (const double value : {kNan, kInfinity, -1e300, 1e200, 1e-320, 0.0}) {
    for (int field = 0; field < 5; ++field) {
      for (int i = 0; i < 4; ++i) {
        LineArray array = lines();
        Line& line = array.lines[0];
        if (field == 0) line.start_normalized[0] = value;
        if (field == 1) line.start_normalized = line.end_normalized = {value, value};
        if (field == 2)
          line.start_px[0] = line.end_px[0] = static_cast<float>(std::clamp(value, -1e38, 1e38));
        if (field == 3) line.sigma_px = static_cast<float>(std::clamp(value, -1e38, 1e38));
        if (field == 4) line.covariance_px.fill(static_cast<float>(std::clamp(value, -1e38, 1e38)));
        send(pose(), array);
      }
    }
  }
  LineArray twice = lines();  // one id three times, ages that do not add up
  for (Line& line : twice.lines) line.id = 0, line.age = 0;
  send(pose(), twice);
  LineArray counted = lines();
  counted.image_count = std::numeric_limits<std::uint64_t>::max();
  send(pose(), counted);
  image_ = 0;  // a bag that begins again
  EXPECT_TRUE(mapsAgain());
}

TEST_F(LineMapperFaults, PosesThatNoEstimatorSendsLeaveTheMapFinite) {
  image_ = 1000;
  for (const double value : {kNan, kInfinity, 1e300, 1e160}) {
    for (int field = 0; field < 3; ++field) {
      for (int i = 0; i < 4; ++i) {
        geometry_msgs::TransformStamped bad = pose();
        if (field == 0) bad.transform.translation.y = i % 2 == 0 ? value : -value;
        if (field == 1) bad.transform.rotation.w = value;
        if (field == 2) bad.transform.rotation.w = 0.0;
        send(bad, lines());
      }
    }
  }
  EXPECT_TRUE(log_.holds({"images had no pose within"}));
  image_ = 2000;
  EXPECT_TRUE(mapsAgain());
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "line_mapper_faults_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
