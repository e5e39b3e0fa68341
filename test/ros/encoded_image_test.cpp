#include "encoded_image.h"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

/// Smooth in both directions, as a JPEG keeps it.
cv::Mat slope(int type) {
  cv::Mat picture(60, 80, type);
  cv::Mat gray(60, 80, CV_8UC1);
  for (int y = 0; y < gray.rows; ++y) {
    for (int x = 0; x < gray.cols; ++x) gray.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(2 * x + y);
  }
  if (type == CV_8UC1) return gray;
  if (type == CV_16UC1) {
    gray.convertTo(picture, type, 256.0);
  } else {
    cv::cvtColor(gray, picture, type == CV_8UC3 ? cv::COLOR_GRAY2BGR : cv::COLOR_GRAY2BGRA);
  }
  return picture;
}

sensor_msgs::CompressedImage compressed(const cv::Mat& picture, const std::string& file,
                                        const std::string& format) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = ros::Time(12.5);
  message.header.frame_id = "camera";
  message.format = format;
  cv::imencode(file, picture, message.data);
  return message;
}

std::string complaint(const sensor_msgs::CompressedImage& message, DecoderWarnings warnings) {
  try {
    decompress(message, warnings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Decompress, GivesThePixelsWithTheirEncoding) {
  struct Case {
    int type;
    std::string format, encoding;
  };
  for (const Case& c : {Case{CV_8UC1, "mono8; png compressed mono8", encodings::MONO8},
                        {CV_8UC1, "png", encodings::MONO8},
                        {CV_8UC1, "", encodings::MONO8},
                        {CV_8UC1, "bayer_rggb8; png compressed ", encodings::BAYER_RGGB8},
                        {CV_8UC1, "bayer_rggb16; png compressed ", encodings::MONO8},
                        {CV_8UC3, "rgb8; png compressed bgr8", encodings::BGR8},
                        {CV_8UC3, "bayer_rggb8; png compressed bgr8", encodings::BGR8},
                        {CV_8UC4, "bgra8; png compressed bgra8", encodings::BGRA8},
                        {CV_16UC1, "16UC1; png compressed ", encodings::MONO16}}) {
    const cv::Mat picture = slope(c.type);
    const cv_bridge::CvImage image =
        decompress(compressed(picture, ".png", c.format), DecoderWarnings::kArePrinted);
    EXPECT_EQ(image.encoding, c.encoding) << c.format;
    EXPECT_EQ(image.header.stamp, ros::Time(12.5));
    EXPECT_EQ(image.header.frame_id, "camera");
    ASSERT_EQ(image.image.type(), c.type) << c.format;
    EXPECT_EQ(cv::norm(image.image, picture, cv::NORM_INF), 0.0) << c.format;
  }
}

TEST(Decompress, ReadsJpegs) {
  const cv::Mat picture = slope(CV_8UC1);
  const cv_bridge::CvImage image =
      decompress(compressed(picture, ".jpg", "mono8; jpeg compressed "), DecoderWarnings::kArePrinted);
  EXPECT_EQ(image.encoding, encodings::MONO8);
  EXPECT_LE(cv::norm(image.image, picture, cv::NORM_INF), 3.0);
}

TEST(Decompress, SaysWhatCannotBeDecoded) {
  for (const DecoderWarnings warnings : {DecoderWarnings::kAreDamage, DecoderWarnings::kArePrinted}) {
    sensor_msgs::CompressedImage message = compressed(slope(CV_8UC1), ".png", "png");
    message.data.resize(message.data.size() / 2);
    EXPECT_EQ(complaint(message, warnings),
              "compressed image (png) is cut off after " + std::to_string(message.data.size()) + " bytes");
    message.data.clear();
    EXPECT_EQ(complaint(message, warnings), "compressed image (png) is not an image that OpenCV can decode");
    message.data.assign(1000, 7);
    EXPECT_EQ(complaint(message, warnings), "compressed image (png) is not an image that OpenCV can decode");
    cv::Mat colour;
    slope(CV_8UC3).convertTo(colour, CV_16UC3, 256.0);
    EXPECT_EQ(complaint(compressed(colour, ".png", "png"), warnings),
              "compressed image (png) has 3 channels of 16 bits, needs 8-bit gray or colour, or 16-bit gray");
  }
}

TEST(Decompress, NoticesDamageWhereTheDecoderIsHeard) {
  cv::Mat noise(200, 200, CV_8UC1);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  sensor_msgs::CompressedImage message = compressed(noise, ".jpg", "jpeg");
  // A marker where code should be.
  message.data[message.data.size() / 2] = 0xFF;
  message.data[message.data.size() / 2 + 1] = 0xD1;
  EXPECT_NE(complaint(message, DecoderWarnings::kAreDamage).find("is damaged (Corrupt JPEG data"),
            std::string::npos);
  EXPECT_EQ(complaint(message, DecoderWarnings::kArePrinted), "");
}

}  // namespace
}  // namespace tet_line_tracker
