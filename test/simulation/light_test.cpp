#include "simulation/light.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

Simulation makeSimulation(const std::string& light, const std::string& motion, bool textureless_phase,
                          double seconds) {
  SimulationOptions options;
  options.light = light;
  options.motion = motion;
  options.textureless_phase = textureless_phase;
  options.seconds = seconds;
  options.rate_hz = 4.0;
  options.threads = 2;
  return Simulation(options, makeCameraModel(defaultSimulatedCamera()));
}

double meanGray(Simulation& simulation) {
  double sum = 0.0;
  for (int i = 0; i < simulation.imageCount(); ++i) sum += cv::mean(simulation.nextImage())[0];
  return sum / simulation.imageCount();
}

TEST(Light, LowLightHasAMeanGrayOfAboutFifteen) {
  for (const char* motion : {"slow", "corridor"}) {
    Simulation simulation = makeSimulation("low", motion, false, 4.0);
    EXPECT_NEAR(15.0, meanGray(simulation), 2.0) << motion;
  }
}

TEST(Light, NormalLightFillsTheRangeWithoutSaturation) {
  Simulation simulation = makeSimulation("normal", "slow", false, 4.0);
  int saturated = 0;
  double sum = 0.0;
  for (int i = 0; i < simulation.imageCount(); ++i) {
    const cv::Mat image = simulation.nextImage();
    saturated += cv::countNonZero(image == 255);
    sum += cv::mean(image)[0];
  }
  EXPECT_NEAR(105.0, sum / simulation.imageCount(), 12.0);
  EXPECT_LT(saturated, simulation.imageCount() * 400);
}

TEST(Light, NoiseOfAStillCameraIsThatOfTheSensor) {
  for (const auto& [light, lowest, highest] :
       {std::make_tuple("normal", 1.2, 2.6), std::make_tuple("low", 0.7, 1.3)}) {
    Simulation simulation = makeSimulation(light, "still", false, 1.0);
    const cv::Mat first = simulation.nextImage();
    cv::Mat difference;
    cv::subtract(first, simulation.nextImage(), difference, cv::noArray(), CV_32F);
    const double noise = cv::norm(difference) / std::sqrt(2.0 * static_cast<double>(difference.total()));
    EXPECT_GT(noise, lowest) << light;
    EXPECT_LT(noise, highest) << light;
  }
}

TEST(LightSchedule, GainJumpsStayBetweenSixTenthsAndTwelveTenthsFromImageToImage) {
  LightSchedule schedule(parseLight("gain_jumps"), 3);
  double last = 1.0;
  double smallest = 10.0;
  double largest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double gain = schedule.nextGain(0.05 * i);
    smallest = std::min(smallest, gain / last);
    largest = std::max(largest, gain / last);
    EXPECT_GE(gain, 0.499);
    EXPECT_LE(gain, 1.101);
    last = gain;
  }
  EXPECT_GT(smallest, 0.599);
  EXPECT_LT(smallest, 0.65);
  EXPECT_GT(largest, 1.15);
  EXPECT_LT(largest, 1.201);
}

TEST(LightSchedule, DriftsSlowly) {
  LightSchedule schedule(parseLight("drift"), 3);
  double last = schedule.nextGain(0.0);
  double lowest = last;
  double highest = last;
  for (int i = 1; i < 400; ++i) {
    const double gain = schedule.nextGain(0.05 * i);
    EXPECT_NEAR(1.0, gain / last, 0.02);
    lowest = std::min(lowest, gain);
    highest = std::max(highest, gain);
    last = gain;
  }
  EXPECT_GT(highest / lowest, 2.0);
}

TEST(LightSchedule, NamesTheUnknownLight) {
  EXPECT_THROW(parseLight("low,candle"), std::invalid_argument);
  EXPECT_TRUE(parseLight("low,drift").low);
  EXPECT_TRUE(parseLight("low,drift").drift);
  EXPECT_FALSE(parseLight("normal").low);
}

TEST(TexturelessPhase, ShowsNoEdgeForASecondAndAHalf) {
  for (const char* motion : {"slow", "corridor"}) {
    Simulation simulation = makeSimulation("normal", motion, true, 10.0);
    const auto strongestEdge = [&](double time_s) {
      cv::Mat gradient;
      cv::Mat smooth;
      cv::GaussianBlur(simulation.idealImage(simulation.stampAt(time_s)), smooth, cv::Size(7, 7), 1.5);
      cv::Sobel(smooth, gradient, CV_32F, 1, 0, 3, 0.125);
      double largest = 0.0;
      cv::minMaxLoc(cv::abs(gradient), nullptr, &largest);
      return largest;
    };
    for (const double t : {4.27, 4.6, 5.0, 5.4, 5.73}) EXPECT_LT(strongestEdge(t), 2.0) << motion << t;
    EXPECT_GT(strongestEdge(0.0), 10.0) << motion;
    EXPECT_GT(strongestEdge(9.0), 10.0) << motion;
  }
}

}  // namespace
}  // namespace tet_line_tracker
