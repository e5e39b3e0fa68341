#include "stream_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace tet_line_tracker {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;

/// A frame with lines of ages 1 to 20.
LineFrame frameWithLines() {
  LineFrame frame;
  for (std::uint32_t age = 1; age <= 20; ++age) frame.lines.emplace_back().age = age;
  return frame;
}

/// Diagnostics of a node that has tracked one image and has all it asks for.
class StreamDiagnosticsTest : public testing::Test {
 protected:
  StreamDiagnosticsTest() {
    setup_.calibrated = true;
    diagnostics_.addReceived();
    diagnostics_.addTracked(frameWithLines());
    diagnostics_.addPublished(0.02);
  }
  diagnostic_updater::DiagnosticStatusWrapper report() {
    diagnostic_updater::DiagnosticStatusWrapper status;
    diagnostics_.report(setup_, status);
    return status;
  }
  /// Of the interval since the last call.
  std::map<std::string, std::string> values() {
    std::map<std::string, std::string> values;
    for (const auto& value : report().values) {
      EXPECT_TRUE(values.emplace(value.key, value.value).second) << value.key << " is there twice";
    }
    return values;
  }
  /// Reports until trouble is forgotten.
  void waitForCalm() {
    for (int i = 0; i <= LevelHysteresis::kCalmReports; ++i) report();
  }

  StreamDiagnostics diagnostics_;
  StreamDiagnostics::Setup setup_;
};

TEST_F(StreamDiagnosticsTest, AreOkWhenNothingIsAmiss) {
  const auto status = report();
  EXPECT_EQ(status.level, Status::OK);
  EXPECT_EQ(status.message, "20 lines");
  EXPECT_EQ(values()["images tracked"], "1");
}

TEST_F(StreamDiagnosticsTest, TellMeanAndLargestTimeOfEachStage) {
  LineFrame frame = frameWithLines();
  values();
  FrameStatistics& s = frame.statistics;
  s.pyramid_ms = 1.0, s.prior_ms = 2.0, s.flow_ms = 3.0, s.refine_ms = 4.0, s.detect_ms = 5.0;
  s.undistort_ms = 6.0, s.total_ms = 21.0;
  diagnostics_.addTracked(frame);
  s.pyramid_ms = 2.0, s.prior_ms = 1.0, s.flow_ms = 3.5, s.refine_ms = 0.0, s.detect_ms = 0.0;
  s.undistort_ms = 0.5, s.total_ms = 7.0;
  diagnostics_.addTracked(frame);
  auto told = values();
  EXPECT_EQ(told["time per image, mean [ms]"], "14.00");
  EXPECT_EQ(told["time per image, max [ms]"], "21.00");
  EXPECT_EQ(told["time for pyramid, mean [ms]"], "1.50");
  EXPECT_EQ(told["time for pyramid, max [ms]"], "2.00");
  EXPECT_EQ(told["time for prior, mean [ms]"], "1.50");
  EXPECT_EQ(told["time for flow, max [ms]"], "3.50");
  EXPECT_EQ(told["time for refine, max [ms]"], "4.00");
  EXPECT_EQ(told["time for detect, mean [ms]"], "2.50");
  EXPECT_EQ(told["time for undistort, mean [ms]"], "3.25");
}

TEST_F(StreamDiagnosticsTest, TellTheLatencyOfWhatWasPublishedInTheInterval) {
  diagnostics_.addPublished(0.04);
  auto told = values();
  EXPECT_EQ(told["latency from stamp to publishing, mean [ms]"], "30.00");
  EXPECT_EQ(told["latency from stamp to publishing, max [ms]"], "40.00");
  diagnostics_.addPublished(0.01);
  EXPECT_EQ(values()["latency from stamp to publishing, max [ms]"], "10.00");
}

TEST_F(StreamDiagnosticsTest, TellALatencyBelowZeroOfAClockThatIsBehind) {
  values();
  diagnostics_.addPublished(-0.5);
  EXPECT_EQ(values()["latency from stamp to publishing, max [ms]"], "-500.00");
}

TEST_F(StreamDiagnosticsTest, TellHowLongImagesWaitedForTheirSensors) {
  diagnostics_.addWait(0.002);
  diagnostics_.addWait(0.006);
  diagnostics_.addWithoutSamples();
  auto told = values();
  EXPECT_EQ(told["wait for imu or odometry, mean [ms]"], "4.00");
  EXPECT_EQ(told["wait for imu or odometry, max [ms]"], "6.00");
  EXPECT_EQ(told["images without their imu or odometry messages"], "1");
}

TEST_F(StreamDiagnosticsTest, TellWhatBecameOfTheLines) {
  values();
  LineFrame frame = frameWithLines();
  frame.epoch = 3;
  frame.statistics.coverage = 0.5F;
  frame.statistics.lines_added = 7;
  frame.statistics.lostFor(LossReason::kBorder) = 2;
  frame.statistics.lostFor(LossReason::kFlow) = 1;
  diagnostics_.addTracked(frame);
  frame.statistics.lines_added = 0;
  diagnostics_.addTracked(frame);
  auto told = values();
  EXPECT_EQ(told["epoch"], "3");
  EXPECT_EQ(told["lines live"], "20");
  EXPECT_EQ(told["line age, mean [images]"], "10.5");
  EXPECT_EQ(told["image covered by lines [%]"], "50");
  EXPECT_EQ(told["lines started"], "7");
  EXPECT_EQ(told["lines started per image"], "3.50");
  EXPECT_EQ(told["lines lost per image"], "3.00");
  EXPECT_EQ(told["lines lost: border"], "4");
  EXPECT_EQ(told["lines lost: flow"], "2");
}

TEST_F(StreamDiagnosticsTest, TellByWhatTheImagesWerePredicted) {
  values();
  LineFrame frame = frameWithLines();
  for (const char* prior : {"image", "imu", "imu", "imu"}) {
    frame.statistics.prior = prior;
    diagnostics_.addTracked(frame);
  }
  frame.statistics.translation = {0.0F, 0.0F, 1.0F};
  diagnostics_.addTracked(frame);
  auto told = values();
  EXPECT_EQ(told["prior in use"], "imu");
  EXPECT_EQ(told["images predicted by imu [%]"], "80");
  EXPECT_EQ(told["images predicted by image [%]"], "20");
  EXPECT_EQ(told["images predicted by odometry [%]"], "0");
  EXPECT_EQ(told["images predicted by none [%]"], "0");
  EXPECT_EQ(told["images with a known translation [%]"], "20");
}

TEST_F(StreamDiagnosticsTest, TellTimeOffsetLagAndBiasOfTheSensors) {
  EXPECT_EQ(values().count("imu lag [ms]"), 0U) << "without messages there is none";
  LineFrame frame = frameWithLines();
  frame.statistics.imu_time_offset = 0.0203;
  diagnostics_.addTracked(frame);
  diagnostics_.setGyroBias({0.01, -0.02, 0.00305});
  setup_.imu_lag_s = -0.0042;
  setup_.odometry_lag_s = 0.1;
  auto told = values();
  EXPECT_EQ(told["imu time offset [s]"], "0.0203");
  EXPECT_EQ(told["imu lag [ms]"], "-4.2");
  EXPECT_EQ(told["odometry lag [ms]"], "100.0");
  EXPECT_EQ(told["gyroscope bias, x [rad/s]"], "0.01000");
  EXPECT_EQ(told["gyroscope bias, y [rad/s]"], "-0.02000");
  EXPECT_EQ(told["gyroscope bias, z [rad/s]"], "0.00305");
}

TEST_F(StreamDiagnosticsTest, TellTheDetectorInUse) {
  diagnostics_.setDetector("edge");
  EXPECT_EQ(values()["detector"], "edge");
}

TEST_F(StreamDiagnosticsTest, WarnOfAnImuThatIsOutOfStep) {
  setup_.imu_in_step = false;
  const auto status = report();
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "20 lines, the imu is out of step");
}

TEST_F(StreamDiagnosticsTest, WarnOfImagesWithoutCalibration) {
  setup_.calibrated = false;
  EXPECT_EQ(report().level, Status::WARN);
}

TEST_F(StreamDiagnosticsTest, WarnOfFewLinesUntilThereAreClearlyMore) {
  LineFrame frame;
  const auto levelWith = [&](std::size_t lines) {
    frame.lines.resize(lines);
    waitForCalm();
    diagnostics_.addTracked(frame);
    return report().level;
  };
  EXPECT_EQ(levelWith(5), Status::OK);
  EXPECT_EQ(levelWith(4), Status::WARN);
  EXPECT_EQ(levelWith(9), Status::WARN);
  EXPECT_EQ(levelWith(10), Status::OK);
  EXPECT_EQ(levelWith(5), Status::OK);
}

TEST_F(StreamDiagnosticsTest, WarnOfDropsInTheIntervalInWhichTheyHappenedAndAWhileLonger) {
  diagnostics_.addDropped(DropReason::kLate);
  auto status = report();
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "1 of 1 images dropped");
  for (int i = 0; i < LevelHysteresis::kCalmReports; ++i) {
    status = report();
    EXPECT_EQ(status.level, Status::WARN);
    EXPECT_EQ(status.message, "20 lines; shortly before: 1 of 1 images dropped");
  }
  EXPECT_EQ(report().level, Status::OK);
  EXPECT_EQ(values()["images dropped: late stamp"], "1");
  diagnostics_.addDropped(DropReason::kUnreadable);
  EXPECT_EQ(report().level, Status::ERROR);
}

TEST_F(StreamDiagnosticsTest, HaveEveryKeyThatThePlotDraws) {
  std::ifstream file(TET_SOURCE_DIRECTORY "/scripts/plot_diagnostics.py");
  std::ostringstream script;
  script << file.rdbuf();
  const std::string text = script.str();
  const auto told = values();
  const std::regex key("values\\('([^'{]+)(\\{\\})?([^']*)'");
  int keys = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), key); match != std::sregex_iterator(); ++match) {
    ++keys;
    const std::string begin = (*match)[1];
    const std::string end = (*match)[3];
    EXPECT_TRUE(std::any_of(told.begin(), told.end(), [&](const auto& pair) {
      const std::string& name = pair.first;
      const bool longer = (*match)[2].matched ? name.size() > begin.size() + end.size() : name == begin;
      return longer && name.compare(0, begin.size(), begin) == 0 &&
             name.compare(name.size() - end.size(), end.size(), end) == 0;
    })) << match->str();
  }
  EXPECT_GE(keys, 12);
}

TEST(StreamDiagnostics, AreOkAsSoonAsTheCameraStarts) {
  StreamDiagnostics diagnostics;
  StreamDiagnostics::Setup setup;
  setup.calibrated = true;
  diagnostic_updater::DiagnosticStatusWrapper status;
  diagnostics.report(setup, status);
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "waiting for the first image");
  diagnostics.addReceived();
  diagnostics.addTracked(frameWithLines());
  diagnostics.report(setup, status);
  EXPECT_EQ(status.level, Status::OK);
}

TEST(DropOf, EachVerdictHasItsReason) {
  EXPECT_EQ(dropOf(StreamVerdict::kDropZero).reason, DropReason::kZero);
  EXPECT_EQ(dropOf(StreamVerdict::kDropDuplicate).reason, DropReason::kDuplicate);
  EXPECT_EQ(dropOf(StreamVerdict::kDropLate).reason, DropReason::kLate);
}

}  // namespace
}  // namespace tet_line_tracker
