#pragma once

#include <optional>
#include <vector>

#include "dataset.h"

namespace tet_line_tracker {

/// Widest gap between two poses over which one is interpolated [s].
constexpr double kMaxPoseGapS = 0.2;

/// Brings poses in the order of their stamps and keeps the first of those with the same stamp.
void sortTrajectory(std::vector<StampedPose>& trajectory);

/// Pose at a stamp: position linear, rotation by slerp between the two neighbours; nothing before the first,
/// after the last, or inside a gap over kMaxPoseGapS. Precondition: stamps increase.
std::optional<Eigen::Isometry3d> interpolate(const std::vector<StampedPose>& trajectory,
                                             const ros::Time& stamp);

}  // namespace tet_line_tracker
