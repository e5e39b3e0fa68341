#include <gtest/gtest.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../ros/wire_bytes.h"
#include "bag_content.h"
#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/TrackingStatistics.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

constexpr char kFrames[] = "/tf_static";

/// A short flight with fast turns, and copies of its bag with something left out.
class TrackBag : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    flight_folder = std::make_unique<TemporaryFolder>();
    const ToolRun run = runTool("simulate_bag", {flight(), "--motion", "fast", "--seconds", "0.5"});
    ASSERT_EQ(run.status, 0) << run.errors;
  }
  static void TearDownTestSuite() { flight_folder.reset(); }
  static std::string flight() { return flight_folder->path() / "flight.bag"; }
  std::string file(const std::string& name) const { return folder_.path() / name; }

  /// How often each motion prior was used.
  std::map<std::string, int> track(const std::string& bag, const std::vector<std::string>& options,
                                   std::string* errors = nullptr) {
    std::vector<std::string> arguments{bag, file("tracks.bag")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ToolRun run = runTool("track_bag", arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    if (errors != nullptr) *errors = run.errors;
    std::map<std::string, int> priors;
    for (const auto& one : readTopic<TrackingStatistics>(file("tracks.bag"), "/line_tracker/statistics"))
      ++priors[one.message.prior];
    return priors;
  }

  static void copyWithout(const std::string& topic, const std::string& copy,
                          const std::string& bag = flight()) {
    rosbag::Bag from(bag, rosbag::bagmode::Read);
    rosbag::Bag to(copy, rosbag::bagmode::Write);
    rosbag::View view(from);
    for (const rosbag::MessageInstance& instance : view) {
      if (instance.getTopic() != topic) to.write(instance.getTopic(), instance.getTime(), instance);
    }
  }

 private:
  static std::unique_ptr<TemporaryFolder> flight_folder;
  TemporaryFolder folder_;
};

std::unique_ptr<TemporaryFolder> TrackBag::flight_folder;

/// The lines of a bag as they are on the wire.
std::string linesOf(const std::string& path) {
  std::string bytes;
  for (const auto& one : readTopic<LineArray>(path, "/line_tracker/lines")) {
    const Bytes wire = bytesOf(one.message);
    bytes.append(wire.begin(), wire.end());
  }
  return bytes;
}

TEST_F(TrackBag, TakesTheOnlyImuWithItsFramesAndGivesTheSameBytesAgain) {
  std::string errors;
  EXPECT_GE(track(flight(), {}, &errors)["imu"], 8);
  EXPECT_EQ(errors.find("warning"), std::string::npos) << errors;
  const std::string lines = linesOf(file("tracks.bag"));
  track(flight(), {"--imu", "/imu0"});
  EXPECT_GT(lines.size(), 1000U);
  EXPECT_TRUE(linesOf(file("tracks.bag")) == lines);
}

TEST_F(TrackBag, NamesEachLineThatIsGoneWithItsReason) {
  track(flight(), {});
  const auto lines = readTopic<LineArray>(file("tracks.bag"), "/line_tracker/lines");
  const auto statistics = readTopic<TrackingStatistics>(file("tracks.bag"), "/line_tracker/statistics");
  ASSERT_EQ(lines.size(), statistics.size());
  std::size_t gone = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::vector<std::uint64_t> ids;
    for (const Line& line : lines[i - 1].message.lines) {
      const auto& now = lines[i].message.lines;
      const auto same = [&line](const Line& other) { return other.id == line.id; };
      if (std::none_of(now.begin(), now.end(), same)) ids.push_back(line.id);
    }
    const TrackingStatistics& message = statistics[i].message;
    EXPECT_EQ(message.lost_ids, ids);
    ASSERT_EQ(message.lost_reasons.size(), ids.size());
    const auto count = [&message](LossReason reason) {
      return std::count(message.lost_reasons.begin(), message.lost_reasons.end(),
                        static_cast<std::uint8_t>(reason));
    };
    EXPECT_EQ(count(LossReason::kFlow), message.lost_flow);
    EXPECT_EQ(count(LossReason::kSupport), message.lost_support);
    EXPECT_EQ(count(LossReason::kBorder), message.lost_border);
    EXPECT_EQ(count(LossReason::kDuplicate), message.lost_duplicate);
    gone += ids.size();
  }
  EXPECT_GT(gone, 5U);
}

TEST_F(TrackBag, PaintTracksWritesTheReasonsThatTheStatisticsHold) {
  track(flight(), {"--with-images"});
  copyWithout("/line_tracker/statistics", file("no_reasons.bag"), file("tracks.bag"));
  int written = 0;
  const auto statistics = readTopic<TrackingStatistics>(file("tracks.bag"), "/line_tracker/statistics");
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    if (statistics[i].message.lost_ids.empty()) continue;
    cv::Mat pictures[2];
    for (const bool reasons : {false, true}) {
      const std::string bag = file(reasons ? "tracks.bag" : "no_reasons.bag");
      const ToolRun run =
          runTool("paint_tracks", {bag, file("picture.png"), "--no-ids", "--number", std::to_string(i + 1)});
      ASSERT_EQ(run.status, 0) << run.errors;
      pictures[reasons ? 1 : 0] = cv::imread(file("picture.png"));
    }
    ASSERT_EQ(pictures[0].size(), pictures[1].size());
    cv::Mat apart;
    cv::absdiff(pictures[0], pictures[1], apart);
    // Above the legend.
    const int differing = cv::countNonZero(apart.rowRange(0, apart.rows - 40).clone().reshape(1));
    written += differing > 50 ? 1 : 0;
    if (written > 0) break;
  }
  EXPECT_EQ(written, 1);
}

TEST_F(TrackBag, WithoutTheFramesTheImagesPredictAndAWarningNamesThem) {
  copyWithout(kFrames, file("no_frames.bag"));
  std::string errors;
  std::map<std::string, int> priors = track(file("no_frames.bag"), {}, &errors);
  EXPECT_EQ(priors["imu"], 0);
  EXPECT_GE(priors["image"], 8);
  EXPECT_NE(errors.find("'imu0' to the camera's 'cam0'"), std::string::npos) << errors;

  // EuRoC's extrinsic, which simulate_bag uses, as a parameter.
  const auto frames = readTopic<tf2_msgs::TFMessage>(flight(), kFrames);
  ASSERT_EQ(frames.size(), 1U);
  const auto& q = frames[0].message.transforms[0].transform.rotation;
  // The bag holds the pose of the camera in the IMU; the parameter is its inverse.
  const std::string rotation = "imu_rotation=" + std::to_string(-q.x) + " " + std::to_string(-q.y) + " " +
                               std::to_string(-q.z) + " " + std::to_string(q.w);
  EXPECT_GE(track(file("no_frames.bag"), {"--set", rotation}, &errors)["imu"], 8);
  EXPECT_EQ(errors.find("warning"), std::string::npos) << errors;
}

TEST_F(TrackBag, WithoutAnImuTheImagesPredict) {
  copyWithout("/imu0", file("no_imu.bag"));
  std::map<std::string, int> priors = track(file("no_imu.bag"), {});
  EXPECT_EQ(priors["imu"], 0);
  EXPECT_GE(priors["image"], 8);
  EXPECT_EQ(track(flight(), {"--set", "prior=none"})["none"], 11);
}

TEST_F(TrackBag, TakesTheOdometryOfTheBagWhereItIsAskedFor) {
  const std::string driven = file("driven.bag");
  ASSERT_EQ(runTool("simulate_bag", {driven, "--motion", "drive", "--seconds", "0.5", "--odometry"}).status,
            0);
  std::string errors;
  EXPECT_GE(track(driven, {"--set", "prior=odometry"}, &errors)["odometry"], 4);
  EXPECT_EQ(errors.find("warning"), std::string::npos) << errors;
  EXPECT_EQ(track(driven, {})["odometry"], 0);

  const ToolRun none = runTool("track_bag", {flight(), file("never.bag"), "--set", "prior=odometry"});
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.errors.find("has 0 topics of type nav_msgs/Odometry (none), prior=odometry needs one"),
            std::string::npos)
      << none.errors;
  const ToolRun unused = runTool("track_bag", {driven, file("never.bag"), "--odometry", "/odom"});
  EXPECT_NE(unused.status, 0);
  EXPECT_NE(unused.errors.find("--odometry needs --set prior=odometry, prior is auto"), std::string::npos)
      << unused.errors;
  const ToolRun blind = runTool(
      "track_bag", {driven, file("never.bag"), "--set", "prior=odometry", "--set", "ego_motion=false"});
  EXPECT_NE(blind.status, 0);
  EXPECT_NE(blind.errors.find("parameter prior is odometry, needs ego_motion to be true"), std::string::npos)
      << blind.errors;
  EXPECT_FALSE(std::filesystem::exists(file("never.bag")));
}

TEST_F(TrackBag, TheMaskKeepsLinesOutAndMustHaveTheSizeOfTheImages) {
  cv::Mat mask(480, 752, CV_8UC1, cv::Scalar(0));
  mask.colRange(0, 376).setTo(255);
  cv::imwrite(file("mask.png"), mask);
  track(flight(), {"--set", "mask=" + file("mask.png")});
  std::size_t lines = 0;
  for (const auto& array : readTopic<LineArray>(file("tracks.bag"), "/line_tracker/lines")) {
    for (const Line& line : array.message.lines) {
      EXPECT_LT(0.5F * (line.start_px[0] + line.end_px[0]), 377.0F);
      ++lines;
    }
  }
  EXPECT_GT(lines, 50U);

  cv::imwrite(file("small.png"), mask.rowRange(0, 100));
  const ToolRun small =
      runTool("track_bag", {flight(), file("never.bag"), "--set", "mask=" + file("small.png")});
  EXPECT_NE(small.status, 0);
  EXPECT_NE(small.errors.find("the mask is 752x100, the images have 752x480"), std::string::npos)
      << small.errors;
  const ToolRun none = runTool("track_bag", {flight(), file("never.bag"), "--set", "mask=/nowhere.png"});
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.errors.find("parameter mask is /nowhere.png"), std::string::npos) << none.errors;
  EXPECT_FALSE(std::filesystem::exists(file("never.bag")));
}

TEST_F(TrackBag, OnATerminalABarGoesWithAllItsWorkAndEndsItsLine) {
  const ToolRun run = runToolOnTerminal("track_bag", {flight(), file("tracks.bag"), "--with-images"});
  ASSERT_EQ(run.status, 0) << run.output;
  // Eleven images alone would give as many states.
  EXPECT_GT(std::count(run.output.begin(), run.output.end(), '['), 50) << run.output;
  EXPECT_NE(run.output.find("] 100 %\r\n11 images, "), std::string::npos) << run.output;
}

TEST_F(TrackBag, PrintsTheProcessorTimeOfAnImageBesideTheWallTime) {
  const ToolRun run = runTool("track_bag", {flight(), file("tracks.bag"), "--tracker", "lk_endpoints"});
  if (run.errors.find("this build has no tracker") != std::string::npos) GTEST_SKIP() << run.errors;
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto mean = [&run](const std::string& stage) {
    const std::size_t row = run.output.find("\n" + stage + " ");
    return row == std::string::npos ? std::nan("") : std::stod(run.output.substr(row + stage.size() + 2));
  };
  EXPECT_GT(mean("processor"), 0.1) << run.output;
  EXPECT_LT(mean("processor"), 1.2 * mean("total") + 0.5) << run.output;
}

TEST_F(TrackBag, PaintsEveryImageWithItsLinesIntoAVideoOfTheRateOfTheStamps) {
  if (!cv::VideoWriter(file("probe.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {64, 48})
           .isOpened()) {
    GTEST_SKIP() << "this OpenCV cannot write Motion JPEG";
  }
  ASSERT_EQ(runTool("track_bag", {flight(), file("tracks.bag"), "--video", file("flight.avi")}).status, 0);
  cv::VideoCapture video(file("flight.avi"));
  EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 20.0, 0.1);
  cv::Mat picture;
  int images = 0;
  while (video.read(picture)) {
    ++images;
    EXPECT_EQ(picture.size(), cv::Size(752, 480));
    // The images are gray, what is painted is not.
    cv::Mat hsv, saturated;
    cv::cvtColor(picture, hsv, cv::COLOR_BGR2HSV);
    cv::inRange(hsv, cv::Scalar(0, 120, 120), cv::Scalar(180, 255, 255), saturated);
    EXPECT_GT(cv::countNonZero(saturated), 1000);
  }
  EXPECT_EQ(images, 11);
}

TEST_F(TrackBag, LeavesNoVideoWhenItCannotBeWrittenOrTheBagCannotBeRead) {
  const ToolRun name = runTool("track_bag", {flight(), file("never.bag"), "--video", file("flight.gif")});
  EXPECT_NE(name.errors.find("flight.gif: no video, needs .mp4 or .avi"), std::string::npos) << name.errors;
  // The bag is smaller than the limit of files, the video is not.
  const ToolRun full = runTool("track_bag", {flight(), file("never.bag"), "--video", file("flight.avi")},
                               "ulimit -f 2000; trap '' XFSZ; ");
  EXPECT_EQ(full.status, 1) << full.errors;
  EXPECT_NE(full.errors.find("cannot write " + file("flight.avi")), std::string::npos) << full.errors;
  std::vector<std::string> left;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(flight()).parent_path())) {
    left.push_back(entry.path().filename());
  }
  EXPECT_EQ(left, std::vector<std::string>{"flight.bag"});
}

TEST_F(TrackBag, LinesCanBePaintedOverTheImagesOfAnotherBagWithIdsOrWithout) {
  track(flight(), {});
  const ToolRun without = runTool("paint_tracks", {file("tracks.bag"), file("picture.png")});
  EXPECT_NE(without.status, 0);
  const auto paint = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {file("tracks.bag"), file("picture.png"), "--images", flight(), "--number", "5"});
    const ToolRun run = runTool("paint_tracks", options);
    EXPECT_EQ(run.status, 0) << run.errors;
    return cv::imread(file("picture.png"));
  };
  const cv::Mat with_ids = paint({});
  const cv::Mat without_ids = paint({"--no-ids"});
  ASSERT_EQ(with_ids.size(), cv::Size(752, 480));
  cv::Mat apart;
  cv::absdiff(with_ids, without_ids, apart);
  EXPECT_GT(cv::countNonZero(apart.reshape(1)), 500);
}

TEST_F(TrackBag, AnImuThatIsNotThereIsSaid) {
  const ToolRun run = runTool("track_bag", {flight(), file("never.bag"), "--imu", "/gyro"});
  EXPECT_NE(run.status, 0);
  EXPECT_NE(run.errors.find("/gyro"), std::string::npos);
  EXPECT_NE(run.errors.find("/imu0"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace tet_line_tracker
