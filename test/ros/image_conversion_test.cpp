#include "image_conversion.h"

#include <gtest/gtest.h>

#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr double kUpperByte = 1.0 / 256.0;
constexpr int kWidth = 8;
constexpr int kHeight = 6;

/// Message of kWidth x kHeight with `padding` unused bytes behind each row, filled by `fill`.
sensor_msgs::Image imageOf(const std::string& encoding, int bytes_per_pixel, int padding = 0,
                           std::uint8_t fill = 0) {
  sensor_msgs::Image image;
  image.encoding = encoding;
  image.width = kWidth;
  image.height = kHeight;
  image.step = kWidth * bytes_per_pixel + padding;
  image.data.assign(image.step * kHeight, fill);
  return image;
}

void set16(sensor_msgs::Image& image, int x, int y, std::uint16_t value) {
  const std::size_t at = y * image.step + 2 * x;
  image.data[at + (image.is_bigendian != 0 ? 1 : 0)] = static_cast<std::uint8_t>(value & 0xFF);
  image.data[at + (image.is_bigendian != 0 ? 0 : 1)] = static_cast<std::uint8_t>(value >> 8);
}

std::string sentenceFor(const sensor_msgs::Image& image) {
  try {
    toGray(image, kUpperByte);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ImageConversion, SharesTheMemoryOf8BitGray) {
  for (const std::string& encoding : {encodings::MONO8, encodings::TYPE_8UC1}) {
    sensor_msgs::Image image = imageOf(encoding, 1, 5);
    image.data[2 * image.step + 3] = 77;
    const cv::Mat gray = toGray(image, kUpperByte);
    EXPECT_EQ(gray.data, image.data.data());
    EXPECT_EQ(gray.size(), cv::Size(kWidth, kHeight));
    EXPECT_EQ(gray.at<std::uint8_t>(2, 3), 77);
  }
}

TEST(ImageConversion, Scales16BitGrayRoundedAndSaturated) {
  for (const std::string& encoding : {encodings::MONO16, encodings::TYPE_16UC1}) {
    for (const std::uint8_t big_endian : {0, 1}) {
      sensor_msgs::Image image = imageOf(encoding, 2, 4);
      image.is_bigendian = big_endian;
      set16(image, 1, 2, 0x4000);
      set16(image, 3, 4, 1000);
      EXPECT_EQ(toGray(image, kUpperByte).at<std::uint8_t>(2, 1), 64);
      EXPECT_EQ(toGray(image, kUpperByte).at<std::uint8_t>(4, 3), 4);  // 3.9
      EXPECT_EQ(toGray(image, 0.2).at<std::uint8_t>(4, 3), 200);       // a 10-bit camera
      EXPECT_EQ(toGray(image, 0.2).at<std::uint8_t>(2, 1), 255);
    }
  }
}

TEST(ImageConversion, WeighsColoursInTheOrderOfTheEncoding) {
  struct Case {
    std::string encoding;
    int bytes;
    int red;  // place of the red byte
  };
  for (const Case& c : {Case{encodings::BGR8, 3, 2}, Case{encodings::RGB8, 3, 0},
                        Case{encodings::BGRA8, 4, 2}, Case{encodings::RGBA8, 4, 0}}) {
    sensor_msgs::Image image = imageOf(c.encoding, c.bytes);
    for (std::size_t i = c.red; i < image.data.size(); i += c.bytes) image.data[i] = 200;
    EXPECT_NEAR(toGray(image, kUpperByte).at<std::uint8_t>(3, 3), 0.299 * 200, 1.0) << c.encoding;
  }
}

TEST(ImageConversion, UnderstandsBayerAndYuv) {
  for (const std::string& encoding :
       {encodings::BAYER_RGGB8, encodings::BAYER_BGGR8, encodings::BAYER_GBRG8, encodings::BAYER_GRBG8}) {
    EXPECT_NEAR(toGray(imageOf(encoding, 1, 0, 90), kUpperByte).at<std::uint8_t>(3, 3), 90, 1) << encoding;
  }
  // Red sits at even rows and columns of rggb and at odd ones of bggr: the weights tell the two apart.
  sensor_msgs::Image red = imageOf(encodings::BAYER_RGGB8, 1);
  for (int y = 0; y < kHeight; y += 2) {
    for (int x = 0; x < kWidth; x += 2) red.data[y * red.step + x] = 200;
  }
  EXPECT_NEAR(toGray(red, kUpperByte).at<std::uint8_t>(3, 3), 0.299 * 200, 2.0);
  red.encoding = encodings::BAYER_BGGR8;
  EXPECT_NEAR(toGray(red, kUpperByte).at<std::uint8_t>(3, 3), 0.114 * 200, 2.0);

  sensor_msgs::Image yuv = imageOf(encodings::YUV422, 2, 0, 128);  // UYVY
  for (std::size_t i = 1; i < yuv.data.size(); i += 2) yuv.data[i] = 33;
  EXPECT_EQ(toGray(yuv, kUpperByte).at<std::uint8_t>(3, 3), 33);
}

TEST(ImageConversion, NamesWhatItAcceptsWhenTheEncodingIsAnother) {
  const std::string sentence = sentenceFor(imageOf(encodings::TYPE_32FC1, 4));
  EXPECT_NE(sentence.find("32FC1"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("mono8, 8UC1, mono16"), std::string::npos) << sentence;
  EXPECT_NE(sentenceFor(imageOf("", 1)).find("empty"), std::string::npos);
}

TEST(ImageConversion, RefusesMessagesWhoseSizesDoNotFitTogether) {
  sensor_msgs::Image image = imageOf(encodings::MONO8, 1);
  image.data.pop_back();
  EXPECT_NE(sentenceFor(image).find("47 bytes of data, needs 48"), std::string::npos) << sentenceFor(image);

  image = imageOf(encodings::BGR8, 3);
  image.step = kWidth;
  EXPECT_NE(sentenceFor(image).find("step of 8"), std::string::npos) << sentenceFor(image);

  image = imageOf(encodings::MONO16, 2, 1);  // rows of 16-bit values at odd addresses
  EXPECT_NE(sentenceFor(image).find("step of 17"), std::string::npos) << sentenceFor(image);

  image = imageOf(encodings::MONO8, 1);
  image.width = 0;
  EXPECT_NE(sentenceFor(image).find("0x6"), std::string::npos) << sentenceFor(image);

  image = imageOf(encodings::MONO8, 1);
  image.width = 0xFFFFFFFFU;
  image.height = 0xFFFFFFFFU;
  image.step = 0xFFFFFFFFU;
  EXPECT_FALSE(sentenceFor(image).empty());
}

TEST(ImageConversion, RefusesSidesThatNoCameraHas) {
  sensor_msgs::Image image;
  image.encoding = "mono8";
  image.width = image.step = 32768;
  image.height = 1;
  image.data.assign(image.step, 7);
  EXPECT_EQ(sentenceFor(image), "image of 32768x1 mono8 has a size outside 1..32767 px");
  image.height = image.width;
  image.width = image.step = 1;
  EXPECT_EQ(sentenceFor(image), "image of 1x32768 mono8 has a size outside 1..32767 px");
  image.height = 32767;
  EXPECT_EQ(sentenceFor(image), "");
}

TEST(ReadGray, AnImageThatCannotBeReadIsAProblemAndNoException) {
  sensor_msgs::Image image;
  image.encoding = "mono8";
  image.width = image.height = image.step = 4;
  image.data.assign(16, 7);
  EXPECT_EQ(readGray(image, 1.0).problem, "");
  EXPECT_EQ(readGray(image, 1.0).gray.at<std::uint8_t>(3, 3), 7);
  image.data.pop_back();
  const GrayImage broken = readGray(image, 1.0);
  EXPECT_TRUE(broken.gray.empty());
  EXPECT_NE(broken.problem.find("15 bytes of data, needs 16"), std::string::npos) << broken.problem;
}

}  // namespace
}  // namespace tet_line_tracker
