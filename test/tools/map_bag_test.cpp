#include <filesystem>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include "../../src/simulation/scene_geometry.h"
#include "tet_line_tracker/Line3DArray.h"
#include "tet_line_tracker/LineArray.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

/// A camera moves along x and looks along z at two vertical edges 2 m ahead, 40 images at 20 Hz.
class MapBag : public ::testing::Test {
 protected:
  void SetUp() override {
    input_ = (folder_.path() / "tracks.bag").string();
    output_ = (folder_.path() / "map.bag").string();
  }

  void write(const std::string& camera_of_poses) {
    rosbag::Bag bag(input_, rosbag::bagmode::Write);
    SceneGeometry scene;
    for (double x : {0.5, 0.8}) scene.addEdge({{x, -1.0, 2.0}, {x, 1.0, 2.0}});
    std_msgs::String text;
    text.data = scene.toText();
    bag.write(kSceneTopic, ros::Time(99.0), text);
    for (int i = 0; i < 40; ++i) {
      const ros::Time stamp(100.0 + 0.05 * i);
      tf2_msgs::TFMessage tf;
      geometry_msgs::TransformStamped& pose = tf.transforms.emplace_back();
      pose.header.stamp = stamp;
      pose.header.frame_id = "world";
      pose.child_frame_id = camera_of_poses;
      pose.transform.translation.x = 0.05 * i;
      pose.transform.rotation.w = 1.0;
      bag.write("/tf", stamp, tf);
      LineArray array;
      array.header.stamp = stamp;
      array.header.frame_id = "cam0";
      array.image_count = static_cast<std::uint64_t>(i) + 1;
      for (std::uint64_t id = 0; id < 2; ++id) {
        Line line;
        line.id = id;
        line.age = static_cast<std::uint32_t>(i) + 1;
        const double x = ((id == 0 ? 0.5 : 0.8) - 0.05 * i) / 2.0;
        line.start_normalized = {x, -0.25};
        line.end_normalized = {x, 0.25};
        line.start_px = {static_cast<float>(400.0 * x), -100.0F};
        line.end_px = {static_cast<float>(400.0 * x), 100.0F};
        line.sigma_px = 0.1F;
        array.lines.push_back(line);
      }
      bag.write("/line_tracker/lines", stamp, array);
    }
  }

  TemporaryFolder folder_;
  std::string input_, output_;
};

TEST_F(MapBag, WritesAMapThatEvaluateMapFindsExact) {
  write("cam0");
  const ToolRun run = runTool("map_bag", {input_, output_, "--set", "correlated_views=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("40 images, 0 of them without a pose, 2 lines in the map"), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("median / 90 %: reprojection error 0.00 / 0.00 px, parallax"), std::string::npos)
      << run.output;

  rosbag::Bag bag(output_, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery("/line_mapper/lines"));
  EXPECT_EQ(view.size(), 3U) << "at 100 s, 101 s and the end";
  Line3DArray::ConstPtr last;
  for (const rosbag::MessageInstance& instance : view) last = instance.instantiate<Line3DArray>();
  ASSERT_EQ(last->lines.size(), 2U);
  EXPECT_EQ(last->header.frame_id, "world");
  EXPECT_EQ(last->header.stamp, ros::Time(101.95));
  EXPECT_NEAR(last->lines[1].start.x, 0.8, 1e-6);
  EXPECT_NEAR(last->lines[1].end.y, 0.5, 1e-6);
  EXPECT_NE(last->lines[0].finished, 0);
  rosbag::View edges(bag, rosbag::TopicQuery("/ground_truth/edges"));
  ASSERT_EQ(edges.size(), 1U);
  const auto truth = edges.begin()->instantiate<visualization_msgs::Marker>();
  ASSERT_EQ(truth->points.size(), 4U);
  EXPECT_EQ(truth->points[3].x, 0.8);
  EXPECT_EQ(truth->points[3].y, 1.0);
  bag.close();

  const ToolRun judged = runTool("evaluate_map", {output_});
  EXPECT_EQ(judged.status, 0) << judged.errors;
  EXPECT_NE(judged.output.find("map.bag                           2       2        0     0.000"),
            std::string::npos)
      << judged.output;
}

TEST_F(MapBag, SaysWhichFrameIsMissing) {
  write("cam7");
  const ToolRun run = runTool("map_bag", {input_, output_});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("no pose of cam0 in world"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(output_));
  EXPECT_EQ(runTool("map_bag", {input_, output_, "--camera", "cam7"}).status, 0);
}

TEST_F(MapBag, RefusesWhatItDoesNotKnow) {
  write("cam0");
  EXPECT_NE(runTool("map_bag", {input_, output_, "--set", "min_vews=3"}).errors.find("min_views"),
            std::string::npos);
  EXPECT_NE(runTool("map_bag", {input_, output_, "--set", "min_views=1"}).errors.find("min_views is 1"),
            std::string::npos);
  EXPECT_NE(runTool("map_bag", {input_, output_, "--lines", "/none"}).errors.find("no lines on /none"),
            std::string::npos);
  EXPECT_NE(runTool("evaluate_map", {input_}).errors.find("no map on /line_mapper/lines"), std::string::npos);
}

}  // namespace
}  // namespace tet_line_tracker
