#include <sensor_msgs/Image.h>
#include <opencv2/videoio.hpp>

#include "bag_content.h"
#include "dataset_folder.h"

namespace tet_line_tracker {
namespace {

/// Five frames of growing gray at 25 Hz, by the encoder that OpenCV brings along.
class VideoFile : public DatasetFolder {
 protected:
  void SetUp() override {
    DatasetFolder::SetUp();
    file_ = root() / "clip.avi";
    cv::VideoWriter writer(file_.string(), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           25.0, {64, 48});
    if (!writer.isOpened()) GTEST_SKIP() << "this OpenCV cannot write Motion JPEG";
    for (int i = 0; i < 5; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(20 + 40 * i)));
  }

  ToolRun convertVideo(const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments{"video", file_.string(), bag()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runTool("dataset_to_bag", arguments);
  }

  std::filesystem::path file_;
};

TEST_F(VideoFile, KeepsFramesAtTheRateOfTheFile) {
  const ToolRun run = convertVideo();
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 5U);
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_NEAR(images[i].message.header.stamp.toSec(), 1.0 + 0.04 * static_cast<double>(i), 1e-8);
    EXPECT_EQ(images[i].message.encoding, "bgr8");
    EXPECT_EQ(images[i].message.width, 64U);
    EXPECT_NEAR(images[i].message.data.at(0), 20 + 40 * static_cast<int>(i), 3);
  }
}

TEST_F(VideoFile, TakesTheRateOfTheCommandLine) {
  ASSERT_EQ(convertVideo({"--rate", "10"}).status, 0);
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 5U);
  EXPECT_NEAR(images[4].message.header.stamp.toSec(), 1.4, 1e-8);
}

TEST_F(VideoFile, RefusesWhatIsNoVideo) {
  expectFailure("video", "is a folder, not a video file");
  writeText(file_, "not a video");
  const ToolRun run = convertVideo();
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("clip.avi is not a video that OpenCV can decode"), std::string::npos)
      << run.errors;
  EXPECT_FALSE(std::filesystem::exists(bag()));
}

}  // namespace
}  // namespace tet_line_tracker
