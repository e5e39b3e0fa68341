/// What track_bag makes of bags and files that are not as they should be: as the node does, or one sentence.

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sys/stat.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

#include "bag_content.h"
#include "tet_line_tracker/LineArray.h"
#include "tool_run.h"

namespace tet_line_tracker {

/// A message that calls itself `Original` and has another definition.
template <class Original>
struct Foreign {
  std::string content{"an old recording"};
};

}  // namespace tet_line_tracker

namespace ros {
namespace message_traits {
template <class Original>
struct MD5Sum<tet_line_tracker::Foreign<Original>> {
  static const char* value() { return "0123456789abcdef0123456789abcdef"; }
  static const char* value(const tet_line_tracker::Foreign<Original>&) { return value(); }
};
template <class Original>
struct DataType<tet_line_tracker::Foreign<Original>> {
  static const char* value() { return DataType<Original>::value(); }
  static const char* value(const tet_line_tracker::Foreign<Original>&) { return value(); }
};
template <class Original>
struct Definition<tet_line_tracker::Foreign<Original>> {
  static const char* value() { return "string content\n"; }
  static const char* value(const tet_line_tracker::Foreign<Original>&) { return value(); }
};
}  // namespace message_traits
namespace serialization {
template <class Original>
struct Serializer<tet_line_tracker::Foreign<Original>> {
  template <class Stream, class Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.content);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};
}  // namespace serialization
}  // namespace ros

namespace tet_line_tracker {
namespace {

constexpr char kImage[] = "/cam0/image_raw";
constexpr char kInfo[] = "/cam0/camera_info";
constexpr int kImages = 6;

ros::Time stampOf(int i) {
  return ros::Time(100, 50000000U * static_cast<unsigned>(i));
}

/// Rectangles that move by a pixel per image.
cv::Mat pictureOf(int i) {
  cv::Mat picture(240, 320, CV_8UC1, cv::Scalar(40));
  for (int k = 0; k < 4; ++k) {
    cv::rectangle(picture, cv::Rect(20 + 70 * k + i, 30 + 20 * k, 50, 110), cv::Scalar(200), cv::FILLED);
  }
  return picture;
}

sensor_msgs::Image imageOf(int i) {
  std_msgs::Header header;
  header.stamp = stampOf(i);
  header.frame_id = "cam0";
  return *cv_bridge::CvImage(header, "mono8", pictureOf(i)).toImageMsg();
}

sensor_msgs::CompressedImage compressedOf(int i, const std::string& ending) {
  sensor_msgs::CompressedImage message;
  message.header = imageOf(i).header;
  message.format = "mono8; " + ending.substr(1) + " compressed";
  cv::imencode(ending, pictureOf(i), message.data);
  return message;
}

sensor_msgs::CameraInfo infoOf(int i, std::uint32_t width = 320, double focal_length = 200.0) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = stampOf(i);
  info.width = width;
  info.height = 240;
  info.distortion_model = "plumb_bob";
  info.D = {0.0, 0.0, 0.0, 0.0, 0.0};
  const double used = focal_length > 0.0 ? 1.0 : 0.0;
  info.K = {focal_length, 0, 160 * used, 0, focal_length, 120 * used, 0, 0, used};
  return info;
}

class TrackBagInput : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_.path() / name; }
  std::string bag() const { return in("in.bag"); }
  std::string out() const { return in("out.bag"); }

  /// A bag with the images and what `more` writes.
  template <class More>
  void writeBag(const More& more) {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    for (int i = 0; i < kImages; ++i) bag.write(kImage, stampOf(i), imageOf(i));
    more(bag);
  }
  ToolRun track(std::vector<std::string> options = {}) {
    std::filesystem::remove(out());
    options.insert(options.begin(), {bag(), out()});
    return runTool("track_bag", options);
  }
  /// One sentence, no output.
  void expectRefusal(const ToolRun& run, const std::string& sentence) {
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.errors.find(sentence), std::string::npos) << run.errors;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
  std::vector<Recorded<LineArray>> lines() const {
    return readTopic<LineArray>(out(), "/line_tracker/lines");
  }
  /// For each image of the output whether all its lines are normalised; lines there must be.
  std::vector<bool> normalized() const {
    std::vector<bool> result;
    for (const auto& array : lines()) {
      EXPECT_GT(array.message.lines.size(), 4U);
      result.push_back(std::all_of(array.message.lines.begin(), array.message.lines.end(),
                                   [](const Line& line) { return std::isfinite(line.start_normalized[0]); }));
    }
    return result;
  }

  TemporaryFolder folder_;
};

TEST_F(TrackBagInput, SaysOfAnotherDefinitionWhatItIs) {
  const std::string another = "is of another definition (md5 0123456789abcdef0123456789abcdef)";
  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), Foreign<sensor_msgs::CameraInfo>()); });
  expectRefusal(track(),
                "cannot read /cam0/camera_info of " + bag() + ": its sensor_msgs/CameraInfo " + another);
  writeBag([](rosbag::Bag& bag) { bag.write("/imu0", stampOf(0), Foreign<sensor_msgs::Imu>()); });
  expectRefusal(track(), "cannot read /imu0 of " + bag() + ": its sensor_msgs/Imu " + another);
  writeBag([](rosbag::Bag& bag) { bag.write("/old", stampOf(0), Foreign<sensor_msgs::Image>()); });
  expectRefusal(track({"--image", "/old"}),
                "cannot read /old of " + bag() + ": its sensor_msgs/Image " + another);
  writeBag([](rosbag::Bag& bag) { bag.write("/lines", stampOf(0), Foreign<LineArray>()); });
  const ToolRun map = runTool("map_bag", {bag(), out(), "--lines", "/lines"});
  expectRefusal(map, "cannot read /lines of " + bag() + ": its tet_line_tracker/LineArray " + another);
}

TEST_F(TrackBagInput, ABagWithoutAnIndexIsToBeReindexed) {
  {
    rosbag::Bag bag(in("cut.bag"), rosbag::bagmode::Write);
    for (int i = 0; i < 40; ++i) bag.write(kImage, stampOf(i), imageOf(i));
    std::filesystem::copy_file(in("cut.bag"), this->bag());
  }
  expectRefusal(track(), "run `rosbag reindex " + bag() + "` first");
  const ToolRun map = runTool("map_bag", {bag(), out()});
  expectRefusal(map, "run `rosbag reindex " + bag() + "` first");
}

TEST_F(TrackBagInput, CompressedImagesGiveTheSameLines) {
  writeBag([](rosbag::Bag&) {});
  ASSERT_EQ(track().status, 0);
  const std::vector<Recorded<LineArray>> raw = lines();
  {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    for (int i = 0; i < kImages; ++i)
      bag.write("/cam0/image_raw/compressed", stampOf(i), compressedOf(i, ".png"));
    bag.write("/depth/image_raw/compressedDepth", stampOf(0), compressedOf(0, ".png"));
  }
  const ToolRun run = track({"--with-images"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::vector<Recorded<LineArray>> compressed = lines();
  ASSERT_EQ(compressed.size(), raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    EXPECT_GT(raw[i].message.lines.size(), 4U);
    EXPECT_EQ(compressed[i].message.lines.size(), raw[i].message.lines.size());
    EXPECT_EQ(compressed[i].message.lines.at(0).start_px, raw[i].message.lines.at(0).start_px);
    EXPECT_EQ(compressed[i].message.header.stamp, raw[i].message.header.stamp);
  }
  const ToolRun paint =
      runTool("paint_tracks", {out(), in("out.png"), "--image", "/cam0/image_raw/compressed"});
  EXPECT_EQ(paint.status, 0) << paint.errors;
  EXPECT_EQ(cv::imread(in("out.png")).size(), cv::Size(320, 240));
  const ToolRun check = runTool("check_lines", {out(), "--image", "/cam0/image_raw/compressed"});
  EXPECT_NE(check.output.find("6 images: all rules hold"), std::string::npos) << check.output << check.errors;
}

TEST_F(TrackBagInput, ImagesThatCannotBeReadAreDroppedAndCountedAsInTheNode) {
  writeBag([](rosbag::Bag&) {});
  {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    for (int i = 0; i < kImages; ++i) {
      sensor_msgs::Image image = imageOf(i);
      if (i == 2 || i == 3) image.encoding = "32FC1";
      bag.write(kImage, stampOf(i), image);
    }
  }
  const ToolRun run = track();
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.errors.find("warning: image at 100.100000000 of /cam0/image_raw in " + bag() +
                            " is dropped: image encoding is 32FC1"),
            std::string::npos)
      << run.errors;
  EXPECT_EQ(run.errors.find("100.150000000"), std::string::npos) << "told once\n" << run.errors;
  EXPECT_NE(run.output.find("2 images dropped: 2 unreadable"), std::string::npos) << run.output;
  EXPECT_EQ(lines().size(), 4U);

  {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    for (int i = 0; i < kImages; ++i) {
      sensor_msgs::CompressedImage image = compressedOf(i, ".jpg");
      if (i == 4) image.data.resize(image.data.size() / 2);
      bag.write("/cam0/compressed", stampOf(i), image);
    }
  }
  const ToolRun compressed = track();
  EXPECT_EQ(compressed.status, 0);
  EXPECT_NE(compressed.errors.find("is dropped: compressed image (mono8; jpg compressed) is cut off after "),
            std::string::npos)
      << compressed.errors;
  EXPECT_EQ(lines().size(), 5U);

  {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    sensor_msgs::Image image = imageOf(0);
    image.encoding = "32FC1";
    bag.write(kImage, stampOf(0), image);
  }
  const ToolRun none = track();
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.errors.find(bag() + " has no image with a stamp that can be read"), std::string::npos)
      << none.errors;
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(TrackBagInput, ACalibrationOfAnotherSizeIsNotUsedAndToldOnce) {
  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), infoOf(0)); });
  ASSERT_EQ(track().status, 0);
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, true)) << "the control";

  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), infoOf(0, 640)); });
  const ToolRun run = track();
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, false));
  const std::string sentence =
      "warning: /cam0/camera_info of " + bag() + ": camera_info is for images of 640x240";
  EXPECT_NE(run.errors.find(sentence), std::string::npos) << run.errors;
  EXPECT_EQ(run.errors.find(sentence), run.errors.rfind(sentence)) << run.errors;
}

TEST_F(TrackBagInput, ACalibrationOfTheFullImageIsTakenThroughBinningAndRegionOfInterest) {
  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), infoOf(0)); });
  ASSERT_EQ(track().status, 0);
  const auto plain = lines();
  writeBag([](rosbag::Bag& bag) {
    sensor_msgs::CameraInfo info = infoOf(0, 800);
    info.height = 600;
    info.K = {400.0, 0, 160.0 * 2 + 100.0, 0, 400.0, 120.0 * 2 + 60.0, 0, 0, 1};
    info.roi.x_offset = 100;
    info.roi.y_offset = 60;
    info.roi.width = 640;
    info.roi.height = 480;
    info.binning_x = info.binning_y = 2;
    bag.write(kInfo, stampOf(0), info);
  });
  const ToolRun run = track();
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, true)) << run.errors;
  const auto binned = lines();
  for (int i = 0; i < kImages; ++i) {
    const Line& seen = binned.at(static_cast<std::size_t>(i)).message.lines.at(0);
    const Line& expected = plain.at(static_cast<std::size_t>(i)).message.lines.at(0);
    EXPECT_EQ(seen.start_normalized, expected.start_normalized) << i;
    EXPECT_EQ(seen.end_normalized, expected.end_normalized) << i;
  }
}

TEST_F(TrackBagInput, ACalibrationOfZerosMeansUncalibrated) {
  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), infoOf(0, 320, 0.0)); });
  const ToolRun run = track();
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, false));
}

TEST_F(TrackBagInput, ACalibrationHoldsFromItsStampOnAndTheFirstBeforeToo) {
  writeBag([](rosbag::Bag& bag) {
    bag.write(kInfo, stampOf(5), infoOf(1));
    bag.write(kInfo, stampOf(5), infoOf(4, 640));
  });
  EXPECT_EQ(track().status, 0);
  EXPECT_EQ(normalized(), (std::vector<bool>{true, true, true, true, false, false}));
}

TEST_F(TrackBagInput, ABagWithoutCalibrationIsTrackedInPixelsAndSaysSo) {
  writeBag([](rosbag::Bag&) {});
  const ToolRun run = track();
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.errors.find("warning: no camera_info in " + bag()), std::string::npos) << run.errors;
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, false));
}

TEST_F(TrackBagInput, NamesTheOptionForOneOfSeveralTopicsAndTheContentWhereThereIsNone) {
  writeBag([](rosbag::Bag& bag) {
    bag.write("/cam1/image_raw", stampOf(0), imageOf(0));
    bag.write(kInfo, stampOf(0), infoOf(0));
    bag.write("/cam1/camera_info", stampOf(0), infoOf(0, 640));
  });
  expectRefusal(track(), "2 topics with images (/cam0/image_raw, /cam1/image_raw): name one with --image");
  EXPECT_EQ(track({"--image", kImage}).status, 0);
  EXPECT_EQ(normalized(), std::vector<bool>(kImages, true)) << "with the camera_info beside it";
  writeBag([](rosbag::Bag& bag) {
    bag.write("/left/camera_info", stampOf(0), infoOf(0));
    bag.write("/right/camera_info", stampOf(0), infoOf(0));
  });
  expectRefusal(track(), "(/left/camera_info, /right/camera_info): name one with --camera-info");
  {
    rosbag::Bag bag(this->bag(), rosbag::bagmode::Write);
    bag.write("/imu0", stampOf(0), sensor_msgs::Imu());
  }
  expectRefusal(
      track(),
      bag() + " has no images (sensor_msgs/Image or CompressedImage); it has: /imu0 (sensor_msgs/Imu)");
}

TEST_F(TrackBagInput, WarnsOfAMaskThatIsBlackOrColoured) {
  writeBag([](rosbag::Bag& bag) { bag.write(kInfo, stampOf(0), infoOf(0)); });
  const auto errorsWith = [&](const cv::Mat& mask) {
    cv::imwrite(in("mask.png"), mask);
    const ToolRun run = track({"--set", "mask=" + in("mask.png")});
    EXPECT_EQ(run.status, 0) << run.errors;
    return run.errors;
  };
  cv::Mat mask(240, 320, CV_8UC3, cv::Scalar::all(0));
  EXPECT_EQ(errorsWith(mask),
            "warning: the mask " + in("mask.png") + " is black everywhere: no line can be tracked\n");
  mask.colRange(0, 160).setTo(cv::Scalar::all(255));
  EXPECT_EQ(errorsWith(mask), "");
  mask.col(200).setTo(cv::Scalar(0, 0, 255));
  EXPECT_EQ(errorsWith(mask), "warning: the mask " + in("mask.png") +
                                  " is coloured: lines are tracked where its gray value is 128 or more\n");
}

TEST_F(TrackBagInput, RefusesAParameterThatAFileSetsTwice) {
  writeBag([](rosbag::Bag&) {});
  writeText(in("twice.yaml"), "min_length: 30\nmax_residual: 0.1\nmin_length: 40\n");
  expectRefusal(track({"--config", in("twice.yaml")}), in("twice.yaml") + ":3: min_length is set twice");
}

TEST_F(TrackBagInput, DoesNotWaitForAFifo) {
  ASSERT_EQ(mkfifo(bag().c_str(), 0600), 0);
  const ToolRun run = runTool("track_bag", {bag(), out()}, "timeout -s KILL 60 ");
  expectRefusal(run, "cannot read " + bag() + ": it is no regular file");
}

}  // namespace
}  // namespace tet_line_tracker
