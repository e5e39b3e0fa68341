/// Point messages that come from a recording, or that came before the bridge did.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <sensor_msgs/PointCloud.h>
#include <topic_tools/shape_shifter.h>

#include "managed_nodelet.h"
#include "node_stream.h"
#include "wire_bytes.h"

namespace tet_line_tracker {
namespace {

class BridgeFaults : public ::testing::Test {
 protected:
  /// A player: it publishes bytes, in which the numbers of the recording stay.
  ros::Publisher player(const sensor_msgs::PointCloud& first) {
    const topic_tools::ShapeShifter shifter = withoutType(first);
    ros::Publisher publisher = shifter.advertise(node_, "/feature_tracker/feature", 100);
    EXPECT_TRUE(waitFor([&] { return publisher.getNumSubscribers() == 1; }));
    return publisher;
  }
  static topic_tools::ShapeShifter withoutType(const sensor_msgs::PointCloud& message) {
    topic_tools::ShapeShifter shifter;
    Bytes bytes = bytesOf(message);
    ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    shifter.morph(ros::message_traits::md5sum(message), ros::message_traits::datatype(message),
                  ros::message_traits::definition(message), "");
    shifter.read(in);
    return shifter;
  }
  static sensor_msgs::PointCloud points(std::uint32_t number) {
    sensor_msgs::PointCloud message;
    message.header.seq = number;
    message.header.stamp = kStart + ros::Duration(0.1) * number;
    return message;
  }

  ManagerLog log_;
  ros::NodeHandle node_;
};

TEST_F(BridgeFaults, PointsOfARecordingPlayedFromItsMiddleAreNoWarning) {
  std::size_t answers = 0;
  std::map<std::string, std::string> diagnostics;
  const auto take = [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
    for (const auto& status : array->status) {
      for (const auto& value : status.values) diagnostics[value.key] = value.value;
    }
  };
  const ros::Subscriber lines = node_.subscribe<sensor_msgs::PointCloud>(
      "/linefeature_tracker/linefeature", 100, [&](const sensor_msgs::PointCloud::ConstPtr&) { ++answers; });
  const ros::Subscriber reports =
      node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, take);
  // Until then the bridge has seen that nobody publishes.
  ASSERT_TRUE(waitFor([&] { return lines.getNumPublishers() == 1 && !diagnostics.empty(); }));
  for (const std::uint32_t from : {5000U, 9000U}) {
    ros::Publisher publisher = player(points(from));
    const std::size_t before = answers;
    for (std::uint32_t i = 0; i < 10; ++i) publisher.publish(withoutType(points(from + i)));
    ASSERT_TRUE(waitFor([&] { return answers == before + 10; })) << answers;
    publisher.shutdown();
    waitFor([] { return false; }, 2.5);
  }
  EXPECT_EQ(diagnostics["point messages"], "20");
  EXPECT_EQ(diagnostics["point messages missed"], "0");
  EXPECT_EQ(log_.count({"did not arrive here"}), 0);

  // A gap within one recording is told.
  ros::Publisher publisher = player(points(100));
  for (const std::uint32_t number : {100U, 101U, 109U}) publisher.publish(withoutType(points(number)));
  EXPECT_TRUE(log_.holds({"7 point messages were published that did not arrive here"}));
  EXPECT_TRUE(waitFor([&] { return diagnostics["point messages missed"] == "7"; }));
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pl_vins_bridge_faults_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
