#include "stream_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;

/// Diagnostics of a node that has tracked one image and has all it asks for.
class StreamDiagnosticsTest : public testing::Test {
 protected:
  StreamDiagnosticsTest() {
    setup_.calibrated = true;
    diagnostics_.addReceived();
    diagnostics_.addTracked(LineFrame(), 1.0);
    diagnostics_.addPublished();
  }
  diagnostic_updater::DiagnosticStatusWrapper report() {
    diagnostic_updater::DiagnosticStatusWrapper status;
    diagnostics_.report(setup_, status);
    return status;
  }
  std::string valueOf(const std::string& key) {
    for (const auto& value : report().values) {
      if (value.key == key) return value.value;
    }
    return "no " + key;
  }

  StreamDiagnostics diagnostics_;
  StreamDiagnostics::Setup setup_;
};

TEST_F(StreamDiagnosticsTest, AreOkWhenNothingIsAmiss) {
  EXPECT_EQ(report().level, Status::OK);
  EXPECT_EQ(valueOf("images tracked"), "1");
}

TEST_F(StreamDiagnosticsTest, TellTheTimeOffsetOfTheImu) {
  LineFrame frame;
  frame.statistics.imu_time_offset = 0.0203;
  diagnostics_.addTracked(frame, 1.0);
  EXPECT_EQ(valueOf("imu time offset [s]"), "0.0203");
}

TEST_F(StreamDiagnosticsTest, WarnOfAnImuThatIsOutOfStep) {
  setup_.imu_in_step = false;
  const auto status = report();
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "0 lines, the imu is out of step");
}

TEST_F(StreamDiagnosticsTest, WarnOfImagesWithoutCalibration) {
  setup_.calibrated = false;
  EXPECT_EQ(report().level, Status::WARN);
}

TEST_F(StreamDiagnosticsTest, TellDropsInTheIntervalInWhichTheyHappened) {
  diagnostics_.addDropped(DropReason::kLate);
  EXPECT_EQ(report().level, Status::WARN);
  EXPECT_EQ(report().level, Status::OK);
  EXPECT_EQ(valueOf("images dropped: late stamp"), "1");
  diagnostics_.addDropped(DropReason::kUnreadable);
  EXPECT_EQ(report().level, Status::ERROR);
}

TEST(DropOf, EachVerdictHasItsReason) {
  EXPECT_EQ(dropOf(StreamVerdict::kDropZero).reason, DropReason::kZero);
  EXPECT_EQ(dropOf(StreamVerdict::kDropDuplicate).reason, DropReason::kDuplicate);
  EXPECT_EQ(dropOf(StreamVerdict::kDropLate).reason, DropReason::kLate);
}

}  // namespace
}  // namespace tet_line_tracker
