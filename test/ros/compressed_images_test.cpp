/// The nodelet on images of the transport `compressed`, without a plugin of image_transport.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>
#include <opencv2/imgcodecs.hpp>

#include <string>

#include "managed_nodelet.h"
#include "node_stream.h"
#include "wire_bytes.h"

namespace tet_line_tracker {
namespace {

namespace scene = synthetic_scene;

sensor_msgs::CompressedImage compressedPicture(int i) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = kStart + kPeriod * i;
  message.header.frame_id = scene::kFrame;
  message.format = "mono8; png compressed ";
  cv::imencode(".png", scene::picture(i), message.data);
  return message;
}

TEST(CompressedImages, GiveTheLinesOfTheImagesThemselves) {
  for (const char* name : {"raw", "compressed"})
    ros::param::set(std::string("/") + name + "/queue_size", 1000);
  ros::param::set("/compressed/image_transport", "compressed");
  const ManagedNodelet raw_node("raw");
  const ManagedNodelet compressed_node("compressed");
  ASSERT_TRUE(raw_node.isLoaded());
  ASSERT_TRUE(compressed_node.isLoaded());
  Stream raw("raw");
  Stream compressed("compressed", Stream::Images::kCompressed);
  ASSERT_TRUE(raw.connected());
  ASSERT_TRUE(compressed.connected());
  constexpr int kImages = 20;
  raw.sendPictures(0, kImages);
  for (int i = 0; i < kImages; ++i) compressed.send(compressedPicture(i));
  ASSERT_TRUE(raw.receives(kImages));
  ASSERT_TRUE(compressed.receives(kImages)) << compressed.lines.size();
  EXPECT_EQ(compressed.lines.back().lines.at(0).age, static_cast<unsigned>(kImages));
  for (std::size_t i = 0; i < kImages; ++i) {
    EXPECT_EQ(bytesOf(compressed.lines[i]), bytesOf(raw.lines[i])) << i;
  }
}

TEST(CompressedImages, ThatCannotBeDecodedAreDroppedAndCounted) {
  const ManagerLog log;
  ros::param::set("/broken/image_transport", "compressed");
  ros::param::set("/broken/queue_size", 1000);
  const ManagedNodelet node("broken");
  ASSERT_TRUE(node.isLoaded());
  Stream stream("broken", Stream::Images::kCompressed);
  ASSERT_TRUE(stream.connected());
  for (int i = 0; i < 10; ++i) {
    sensor_msgs::CompressedImage image = compressedPicture(i);
    if (i == 4) image.data.resize(image.data.size() / 2);
    if (i == 6) image.data.clear();
    stream.send(image);
  }
  ASSERT_TRUE(stream.receives(8)) << stream.lines.size();
  EXPECT_EQ(stream.lines.back().epoch, stream.lines.front().epoch)
      << "an image that is missing ends no track";
  EXPECT_EQ(stream.lines.back().lines.at(0).age, 8U);
  EXPECT_TRUE(log.holds({"/broken/image/compressed dropped", "is cut off after"}));
  EXPECT_TRUE(waitFor([&] { return stream.diagnostics["images dropped: unreadable"] == "2"; }));
}

TEST(CompressedImages, ThatDoNotComeAreMissedByTheNameOfTheirTopic) {
  const ManagerLog log;
  ros::param::set("/silent/image_transport", "compressed");
  const ManagedNodelet node("silent");
  ASSERT_TRUE(node.isLoaded());
  const Stream stream("silent", Stream::Images::kCompressed);
  EXPECT_TRUE(log.holds({"no image for", "on /silent/image/compressed (publishers: 1)"}));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "compressed_images_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
