/// The stand-alone node is started with wrong parameters and must say what is wrong with them and end.

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <array>
#include <cstdio>

#include "node_parameters.h"

namespace tet_line_tracker {
namespace {

struct Outcome {
  std::string output;
  int status{-1};
};

/// Runs the node with `arguments` until it ends, or for 10 s.
Outcome runNode(const std::string& arguments) {
  Outcome outcome;
  const std::string command = "timeout 10 " TET_TOOL_DIRECTORY "/line_tracker " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 512> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.output += buffer.data();
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

void expectRefusal(const std::string& arguments, const std::vector<std::string>& words) {
  static int run = 0;  // a name of its own: parameters stay on the server
  const Outcome outcome = runNode(arguments + " __name:=refused_" + std::to_string(run++));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  for (const std::string& word : words) {
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word << " is not in " << outcome.output;
  }
}

TEST(Parameters, OfAnUnknownNameStopTheNodeWithTheNearestOne) {
  expectRefusal("_windo_px:=9", {"parameter windo_px is not known", "did you mean window_px?"});
}

TEST(Parameters, OutOfRangeStopTheNodeWithTheValueAndTheRange) {
  expectRefusal("_window_px:=8 _publish_rate:=-3.0", {"parameter window_px is 8", "odd number in 3..21",
                                                      "parameter publish_rate is -3", "0..1000"});
}

TEST(Parameters, OfAWrongTypeStopTheNode) {
  ros::NodeHandle("typed").setParam("max_lines", std::vector<int>{1, 2});
  const Outcome outcome = runNode("__name:=typed");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("parameter max_lines is a list, needs a whole number"), std::string::npos)
      << outcome.output;
}

TEST(Parameters, ThatNameNoTransportStopTheNode) {
  expectRefusal("_image_transport:=pigeon", {"parameter image_transport is pigeon", "compressed", "raw"});
}

TEST(Parameters, AreReadWithTheirTypes) {
  ros::NodeHandle node("read");
  node.setParam("max_residual", 0.1234567890123);
  node.setParam("min_length", 25);  // a whole number will do for a length
  node.setParam("detector", "lsd");
  node.setParam("marker_ids", true);
  node.setParam("debug_image/compressed/jpeg_quality", 80);  // of a transport plugin
  LineTrackerParameters tracker;
  NodeParameters parameters;
  loadParameters(node, tracker, parameters);
  EXPECT_EQ(tracker.flow.max_residual, 0.1234567890123);
  EXPECT_EQ(tracker.detection.min_length, 25.0);
  EXPECT_EQ(tracker.detection.detector, "lsd");
  EXPECT_TRUE(parameters.marker_ids);
  EXPECT_EQ(parameters.queue_size, NodeParameters{}.queue_size);

  node.setParam("window_px", "9");  // in quotes
  EXPECT_THROW(loadParameters(node, tracker, parameters), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_parameters_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
