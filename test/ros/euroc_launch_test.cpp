/// The same images through a launch file that plays them and through track_bag: the lines must be the same,
/// byte for byte.

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "../tools/tool_run.h"
#include "synthetic_scene.h"
#include "tet_line_tracker/LineArray.h"
#include "wire_bytes.h"

namespace tet_line_tracker {
namespace {

namespace scene = synthetic_scene;

/// roslaunch in a process group of its own, stopped with all its nodes at the end of the object's life.
class Launch {
 public:
  explicit Launch(std::vector<std::string> arguments) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    process_ = fork();
    if (process_ == 0) {
      setpgid(0, 0);
      execvp(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Launch() {
    if (process_ <= 0) return;
    kill(process_, SIGINT);
    int status = 0;
    waitpid(process_, &status, 0);
  }
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

 private:
  pid_t process_;
};

void writeSyntheticBag(const std::string& path, int images) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const ros::Time start(1000, 0);
  bag.write("/cam0/camera_info", start, scene::cameraInfo(start));
  for (int i = 0; i < images; ++i) {
    const ros::Time stamp = start + ros::Duration(1.0 + 0.05 * i);
    bag.write("/cam0/camera_info", stamp, scene::cameraInfo(stamp));
    bag.write("/cam0/image_raw", stamp, scene::monoMessage(i, stamp));
  }
}

std::vector<Bytes> linesOfBag(const std::string& path) {
  std::vector<Bytes> lines;
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery("/line_tracker/lines"));
  for (const rosbag::MessageInstance& instance : view) {
    lines.push_back(bytesOf(*instance.instantiate<LineArray>()));
  }
  return lines;
}

/// Starts a launch file that plays the images of `bag` and expects the lines of track_bag.
void expectSameLines(const TemporaryFolder& folder, const std::string& bag,
                     std::vector<std::string> launched) {
  // No image may be dropped, however busy the machine is.
  const std::string config = folder.path() / "config.yaml";
  writeText(config, "queue_size: 1000\nimu_wait: 5.0\n");
  const std::string tracks = folder.path() / "tracks.bag";
  const ToolRun run = runTool("track_bag", {bag, tracks, "--config", config});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::vector<Bytes> expected = linesOfBag(tracks);
  ASSERT_FALSE(expected.empty());

  std::vector<Bytes> received;
  ros::NodeHandle node;
  const boost::function<void(const LineArray::ConstPtr&)> take = [&](const LineArray::ConstPtr& message) {
    received.push_back(bytesOf(*message));
  };
  const ros::Subscriber lines = node.subscribe<LineArray>("/line_tracker/lines", 1000, take);
  launched.insert(launched.begin(), {"roslaunch", "tet_line_tracker"});
  launched.push_back("config:=" + config);
  const Launch launch(launched);
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(60.0);
  while (received.size() < expected.size() && ros::WallTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  ASSERT_EQ(received.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(received[i] == expected[i]) << "message " << i << " differs";
  }
}

TEST(EurocLaunch, GivesTheLinesOfTrackBagForASyntheticBag) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "synthetic.bag";
  writeSyntheticBag(bag, 60);
  expectSameLines(folder, bag, {"euroc.launch", "bag:=" + bag, "rviz:=false", "rate:=2"});
}

TEST(EurocLaunch, GivesTheLinesOfTrackBagForAFlightWithAnImu) {
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "flight.bag";
  ASSERT_EQ(runTool("simulate_bag", {bag, "--motion", "fast", "--seconds", "2"}).status, 0);
  expectSameLines(folder, bag, {"euroc.launch", "bag:=" + bag, "rviz:=false"});
}

TEST(EurocLaunch, PlaysABagWithASpaceInItsPathAndDoesNotWaitForAnRvizThatCannotStart) {
  const TemporaryFolder folder;
  const std::filesystem::path spaced = folder.path() / "my bags";
  std::filesystem::create_directory(spaced);
  const std::string bag = spaced / "it's a flight.bag";
  writeSyntheticBag(bag, 20);
  unsetenv("DISPLAY");
  expectSameLines(folder, bag, {"euroc.launch", "bag:=" + bag, "rviz:=true"});
}

TEST(DatasetLaunch, ConvertsASequenceAndGivesTheLinesOfTrackBag) {
  const std::filesystem::path sequence = sharedData() / "euroc_v1_01" / "mav0";
  if (!std::filesystem::exists(sequence)) GTEST_SKIP() << sequence << " is not there";
  const TemporaryFolder folder;
  const std::string bag = folder.path() / "euroc.bag";
  ASSERT_EQ(runTool("dataset_to_bag", {"euroc", sequence, bag}).status, 0);
  expectSameLines(folder, bag,
                  {"dataset.launch", "dataset:=" + sequence.string(), "format:=euroc",
                   "bag:=" + (folder.path() / "made by play_dataset.bag").string(), "rviz:=false"});
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "euroc_launch_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
