#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sys/stat.h>

#include <fstream>

#include "bag_content.h"
#include "dataset_folder.h"

namespace tet_line_tracker {
namespace {

class ImageFolder : public DatasetFolder {
 protected:
  void SetUp() override {
    DatasetFolder::SetUp();
    writeImage("img1.png", 1);
    writeImage("img10.png", 10);
    writeImage("img2.png", 2);
  }

  std::filesystem::path writeCameraInfo(const std::string& image_width, const std::string& fx = "200.5") {
    std::filesystem::path file = root() / "camera.yaml";
    writeText(file,
              "image_width: " + image_width +
                  "\nimage_height: 12\ncamera_name: test\n"
                  "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [" +
                  fx +
                  ", 0, 8.25, 0, 201.5, 6.5, 0, 0, 1]\n"
                  "distortion_model: plumb_bob\n"
                  "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.3, 0.1, 0.001, -0.002, 0]\n");
    return file;
  }
};

TEST_F(ImageFolder, KeepsTheNaturalOrderOfNamesAtTwentyImagesPerSecond) {
  const ToolRun run = convert("images");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(run.errors.empty()) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 3U);
  const int marks[] = {1, 2, 10};
  for (std::size_t i = 0; i < images.size(); ++i) {
    const sensor_msgs::Image& image = images[i].message;
    EXPECT_EQ(image.data.at(0), marks[i]);
    EXPECT_EQ(image.encoding, "mono8");
    EXPECT_EQ(image.width, 16U);
    EXPECT_EQ(image.height, 12U);
    EXPECT_EQ(image.header.frame_id, "cam0");
    EXPECT_EQ(image.header.stamp, images[i].bag_time);
    EXPECT_NEAR(image.header.stamp.toSec(), 1.0 + 0.05 * static_cast<double>(i), 1e-8);
  }
  EXPECT_TRUE(readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info").empty());
}

TEST_F(ImageFolder, TakesRateAndCalibrationFromTheCommandLine) {
  const ToolRun run = convert("images", {"--rate", "4", "--camera-info", writeCameraInfo("16")});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ(images[2].message.header.stamp, ros::Time(1, 500000000));
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag(), "/cam0/camera_info");
  ASSERT_EQ(infos.size(), 4U) << "one before the first image, then one per image";
  EXPECT_LT(infos[0].bag_time, images[0].bag_time);
  const sensor_msgs::CameraInfo& info = infos[3].message;
  EXPECT_EQ(info.header.stamp, images[2].message.header.stamp);
  EXPECT_EQ(info.K[0], 200.5);
  EXPECT_EQ(info.K[2], 8.25);
  EXPECT_EQ(info.K[4], 201.5);
  EXPECT_EQ(info.K[5], 6.5);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, (std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0.0}));
}

TEST_F(ImageFolder, ThinnedKeepsTheFirstImageAndEveryNthAfterItWithTheirStamps) {
  const ToolRun run = convert("images", {"--rate", "4", "--every", "2"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].message.data.at(0), 1);
  EXPECT_EQ(images[1].message.data.at(0), 10);
  EXPECT_EQ(images[1].message.header.stamp, ros::Time(1, 500000000));
  EXPECT_NE(convert("images", {"--every", "0"}).status, 0);
}

TEST_F(ImageFolder, KeepsColourAndSixteenBits) {
  writeImage("img1.png", 1, CV_8UC3);
  writeImage("img2.png", 2, CV_16UC1);
  ASSERT_EQ(convert("images").status, 0);
  const auto images = readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw");
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ(images[0].message.encoding, "bgr8");
  EXPECT_EQ(images[1].message.encoding, "mono16");
}

TEST_F(ImageFolder, RefusesWhatIsNoImageSequence) {
  writeImage("img3.png", 3, CV_8UC1, {20, 12});
  expectFailure("images", "img3.png is 20x12, the images before it are 16x12");
}

TEST_F(ImageFolder, RefusesCutOffImages) {
  cutOff("img10.png");
  expectFailure("images", "img10.png is cut off");
}

TEST_F(ImageFolder, RefusesCutOffJpegs) {
  writeImage("img4.jpg", 4);
  cutOff("img4.jpg");
  expectFailure("images", "img4.jpg is cut off");
}

TEST_F(ImageFolder, RefusesJpegsThatAreCorruptInTheirMiddle) {
  writeImage("img4.jpg", 4, CV_8UC1, {160, 120});
  std::filesystem::remove(root() / "img1.png");
  std::filesystem::remove(root() / "img2.png");
  std::filesystem::remove(root() / "img10.png");
  ASSERT_EQ(convert("images").status, 0);
  std::filesystem::remove(bag());
  // Ones are no code of any Huffman table.
  std::fstream file(root() / "img4.jpg", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(root() / "img4.jpg") / 2));
  for (int i = 0; i < 40; ++i) file.put(static_cast<char>(i % 2 == 0 ? 0xFF : 0x00));
  file.close();
  expectFailure("images", "img4.jpg is damaged (Corrupt JPEG data: ");
}

TEST_F(ImageFolder, TakesRegularFilesOnly) {
  ASSERT_EQ(mkfifo((root() / "img3.png").c_str(), 0600), 0);
  const ToolRun run = runTool("dataset_to_bag", {"images", root().string(), bag()}, "timeout -s KILL 60 ");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(readTopic<sensor_msgs::Image>(bag(), "/cam0/image_raw").size(), 3U);
  const ToolRun video =
      runTool("dataset_to_bag", {"video", (root() / "img3.png").string(), bag()}, "timeout -s KILL 60 ");
  EXPECT_EQ(video.status, 1);
  EXPECT_EQ(video.errors, "dataset_to_bag: " + (root() / "img3.png").string() + " is no regular file\n");
}

TEST_F(ImageFolder, IsNotReplacedByItsOwnBag) {
  const std::string image = root() / "img1.png";
  const ToolRun run = runTool("dataset_to_bag", {"images", root().string(), image});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.errors, "dataset_to_bag: cannot write " + image + ": it is " + image + " of the input\n");
  EXPECT_EQ(convert("images").status, 0) << "img1.png is still an image";
}

TEST_F(ImageFolder, RefusesFilesThatAreNoImages) {
  writeText(root() / "img2.png", "not an image");
  expectFailure("images", "img2.png is not an image");
}

TEST_F(ImageFolder, RefusesEmptyFolders) {
  std::filesystem::remove_all(root());
  expectFailure("images", "does not exist");
  std::filesystem::create_directories(root());
  expectFailure("images", "holds no images");
}

TEST_F(ImageFolder, RefusesCalibrationsThatCannotBeMeant) {
  expectFailure("images", "the calibration is for 32x12 pixels, the images have 16x12",
                {"--camera-info", writeCameraInfo("32")});
  expectFailure("images", "camera.yaml: image_width is not a number",
                {"--camera-info", writeCameraInfo("wide")});
  expectFailure("images", "camera.yaml: camera_matrix.data[0] is not a number",
                {"--camera-info", writeCameraInfo("16", "20o.5")});
  expectFailure("images", "nowhere.yaml: cannot be opened", {"--camera-info", "/nowhere.yaml"});
}

TEST_F(ImageFolder, RefusesUnknownFormatsAndRatesOutOfRange) {
  expectFailure("imagez", "format \"imagez\" is not known; known: ");
  expectFailure("images", "--rate is 0", {"--rate", "0"});
  expectFailure("images", "--rate is -5", {"--rate=-5"});
}

TEST_F(ImageFolder, RefusesAnOutputThatCannotBeWritten) {
  const ToolRun run = runTool("dataset_to_bag", {"images", root().string(), "/nowhere/out.bag"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("cannot write /nowhere/out.bag"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace tet_line_tracker
