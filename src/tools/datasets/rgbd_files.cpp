#include "rgbd_files.h"

#include "text_table.h"
#include "trajectory.h"

namespace tet_line_tracker {

ros::Time frameStamp(double number, double rate_hz) {
  return ros::Time(kFirstStampS + number / rate_hz);
}

std::vector<StampedPose> readRgbdTrajectory(const std::filesystem::path& file, TrajectoryStamps stamps,
                                            double rate_hz) {
  std::vector<StampedPose> trajectory;
  for (const TextRow& row : readTextTable(file, 8)) {
    const ros::Time stamp =
        stamps == TrajectoryStamps::kSeconds ? row.seconds(0) : frameStamp(row.frameNumber(0), rate_hz);
    trajectory.push_back({stamp, row.poseScalarLast(1)});
  }
  sortTrajectory(trajectory);
  return trajectory;
}

}  // namespace tet_line_tracker
