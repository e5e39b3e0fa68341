#pragma once

#include <filesystem>
#include <vector>

#include "dataset.h"

namespace tet_line_tracker {

/// Units of the 16-bit depth images of TUM RGB-D and ICL-NUIM per metre.
constexpr double kRgbdDepthUnitsPerM = 5000.0;

/// Stamps of a trajectory file.
enum class TrajectoryStamps {
  kSeconds,       ///< as TUM writes them
  kFrameNumbers,  ///< as ICL-NUIM writes them
};

/// Stamp of a numbered image: kFirstStampS for number 0.
ros::Time frameStamp(double number, double rate_hz);

/// Trajectory in TUM's format, `stamp tx ty tz qx qy qz qw`, in the order of stamps; `rate_hz` serves frame
/// numbers.
std::vector<StampedPose> readRgbdTrajectory(const std::filesystem::path& file, TrajectoryStamps stamps,
                                            double rate_hz = 1.0);

}  // namespace tet_line_tracker
