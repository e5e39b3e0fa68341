#include "simulation/camera_effects.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

/// Dark to the left, bright to the right of column 32.
cv::Mat step() {
  cv::Mat image(64, 64, CV_32FC1, cv::Scalar(60.0));
  image.colRange(32, 64).setTo(160.0);
  return image;
}

cv::Mat developed(const std::string& effects, const cv::Mat& raw) {
  return develop(parseCameraEffects(effects), raw.clone(), 1);
}

TEST(CameraEffects, AreReadFromAListAndWrittenAsOne) {
  EXPECT_EQ(parseCameraEffects("none").text(), "none");
  EXPECT_EQ(parseCameraEffects("").text(), "none");
  for (const std::string& name : cameraEffectNames()) EXPECT_EQ(parseCameraEffects(name).text(), name);
  EXPECT_EQ(parseCameraEffects("jpeg,response").text(), "response,jpeg");
  EXPECT_EQ(parseCameraEffects(parseCameraEffects("all").text()).text(), parseCameraEffects("all").text());
}

TEST(CameraEffects, AnUnknownOneIsRefusedWithTheNamesThereAre) {
  try {
    parseCameraEffects("jpeg,bokeh");
    FAIL() << "bokeh was accepted";
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("\"bokeh\""), std::string::npos) << what;
    for (const std::string& name : cameraEffectNames()) EXPECT_NE(what.find(name), std::string::npos) << what;
  }
}

TEST(CameraEffects, WithoutAnyGrayLevelsAreRoundedAndNoMore) {
  const cv::Mat raw = (cv::Mat_<float>(1, 4) << -3.0F, 17.4F, 17.6F, 300.0F);
  const cv::Mat gray = developed("none", raw);
  EXPECT_EQ(std::vector<std::uint8_t>(gray.begin<std::uint8_t>(), gray.end<std::uint8_t>()),
            (std::vector<std::uint8_t>{0, 17, 18, 255}));
}

TEST(CameraEffects, TheResponseLiftsShadowsAndBendsHighlightsDown) {
  cv::Mat ramp(1, 400, CV_32FC1);
  for (int x = 0; x < ramp.cols; ++x) ramp.at<float>(0, x) = static_cast<float>(x);
  const cv::Mat gray = developed("response", ramp);
  for (int x = 1; x < ramp.cols; ++x) {
    EXPECT_GE(gray.at<std::uint8_t>(0, x), gray.at<std::uint8_t>(0, x - 1)) << x;
  }
  EXPECT_GT(gray.at<std::uint8_t>(0, 20), 60);    // from 20
  EXPECT_LT(gray.at<std::uint8_t>(0, 399), 255);  // from 399: no clipping
  const auto riseAt = [&](int x) { return gray.at<std::uint8_t>(0, x + 20) - gray.at<std::uint8_t>(0, x); };
  EXPECT_GT(riseAt(10), 3 * riseAt(250));
}

TEST(CameraEffects, SharpeningPutsAHaloOnBothSidesOfAnEdge) {
  const cv::Mat gray = developed("sharpening", step());
  EXPECT_LT(gray.at<std::uint8_t>(20, 31), 45);
  EXPECT_GT(gray.at<std::uint8_t>(20, 32), 175);
  EXPECT_EQ(gray.at<std::uint8_t>(20, 10), 60);
  EXPECT_EQ(gray.at<std::uint8_t>(20, 55), 160);
}

TEST(CameraEffects, JpegChangesAPictureButLittle) {
  cv::Mat noisy = step();
  cv::RNG random(3);
  for (int y = 0; y < noisy.rows; ++y) {
    for (int x = 0; x < noisy.cols; ++x) noisy.at<float>(y, x) += static_cast<float>(random.gaussian(8.0));
  }
  cv::Mat difference;
  cv::absdiff(developed("jpeg", noisy), developed("none", noisy), difference);
  EXPECT_GT(cv::mean(difference)[0], 1.0);
  EXPECT_LT(cv::mean(difference)[0], 10.0);
}

TEST(CameraEffects, HotPixelsAreTheSameInEveryImageOfACamera) {
  const CameraEffects effects = parseCameraEffects("hot_pixels");
  const cv::Mat gray(480, 752, CV_32FC1, cv::Scalar(100.0));
  const cv::Mat first = develop(effects, gray.clone(), 1);
  const cv::Mat second = develop(effects, gray.clone(), 1);
  const cv::Mat other = develop(effects, gray.clone(), 2);
  EXPECT_EQ(cv::countNonZero(first != second), 0);
  EXPECT_GT(cv::countNonZero(first != other), 0);
  const int stuck = cv::countNonZero(first != 100);
  EXPECT_NEAR(stuck, 480 * 752 / 2500, 40);
  EXPECT_GT(cv::countNonZero(first == 255), stuck / 4);
  EXPECT_GT(cv::countNonZero(first == 0), stuck / 4);
}

TEST(CameraEffects, TheTailIsSkewedAndLeavesTheMiddleOfAPointWhereItIs) {
  cv::Mat light = cv::Mat::zeros(41, 41, CV_32FC1);
  light.at<float>(20, 20) = 1.0F;
  addTail(light);
  double sum = 0.0, first = 0.0, third = 0.0;
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const double weight = static_cast<double>(light.at<float>(y, x));
      sum += weight;
      first += weight * (x - 20);
      third += weight * std::pow(x - 20, 3);
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
  EXPECT_NEAR(first, 0.0, 1e-4);
  EXPECT_GT(third, 1.0);
}

SimulationOptions options(const std::string& effects) {
  SimulationOptions options;
  options.motion = "fast";
  options.seconds = 0.2;
  options.rate_hz = 125.0;
  options.threads = 2;
  options.camera_effects = parseCameraEffects(effects);
  return options;
}

std::vector<cv::Mat> images(const std::string& effects, int count) {
  Simulation simulation(options(effects), makeCameraModel(defaultSimulatedCamera()));
  std::vector<cv::Mat> found;
  for (int i = 0; i < count; ++i) found.push_back(simulation.nextImage());
  return found;
}

/// Noise averaged away, so that what is left is of the scene.
cv::Mat smooth(const cv::Mat& image) {
  cv::Mat smoothed;
  cv::GaussianBlur(image, smoothed, cv::Size(9, 9), 1.5);
  return smoothed;
}

double difference(const cv::Mat& a, const cv::Mat& b, const cv::Range& rows) {
  cv::Mat absolute;
  cv::absdiff(smooth(a).rowRange(rows), smooth(b).rowRange(rows), absolute);
  return cv::mean(absolute)[0];
}

TEST(CameraEffects, ARollingShutterExposesTheTopBeforeAndTheBottomAfterTheStamp) {
  // 8 ms from image to image, 16 ms from the first row to the last.
  const std::vector<cv::Mat> global = images("none", 7);
  const cv::Mat rolling = images("rolling_shutter", 6)[5];
  const cv::Range top(0, 12), middle(234, 246), bottom(468, 480);
  EXPECT_LT(difference(rolling, global[4], top), 0.5 * difference(rolling, global[5], top));
  EXPECT_LT(difference(rolling, global[5], middle), 0.5 * difference(rolling, global[4], middle));
  EXPECT_LT(difference(rolling, global[6], bottom), 0.5 * difference(rolling, global[5], bottom));
}

TEST(CameraEffects, ADefocusedPictureHasLessDetailAndAVignettedOneDarkCorners) {
  const cv::Mat plain = images("none", 1)[0];
  // Of the edges; noise has none that are as steep.
  const auto steepest = [](const cv::Mat& image) {
    cv::Mat slopes;
    cv::Sobel(image, slopes, CV_32F, 1, 0, 3, 0.125);
    std::vector<float> sorted(slopes.begin<float>(), slopes.end<float>());
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() * 999 / 1000];
  };
  EXPECT_LT(steepest(images("defocus", 1)[0]), 0.7F * steepest(plain));
  const cv::Mat vignetted = images("vignette", 1)[0];
  const cv::Rect corner(0, 0, 60, 40), centre(346, 220, 60, 40);
  const double corner_ratio = cv::mean(vignetted(corner))[0] / cv::mean(plain(corner))[0];
  const double centre_ratio = cv::mean(vignetted(centre))[0] / cv::mean(plain(centre))[0];
  EXPECT_LT(corner_ratio, 0.6 * centre_ratio);
}

TEST(CameraEffects, TheResponseIsExposedSoThatPicturesStayAsBright) {
  EXPECT_NEAR(cv::mean(images("response", 1)[0])[0], cv::mean(images("none", 1)[0])[0], 12.0);
}

TEST(CameraEffects, TheScenesDescriptionNamesThemAndIsAsBeforeWithoutThem) {
  const auto description = [](const std::string& effects) {
    return Simulation(options(effects), makeCameraModel(defaultSimulatedCamera())).geometry().toText();
  };
  EXPECT_NE(description("jpeg,defocus").find("camera_effects jpeg,defocus"), std::string::npos);
  EXPECT_EQ(description("none").find("camera_effects"), std::string::npos);
}

}  // namespace
}  // namespace tet_line_tracker
