#include "trajectory.h"

#include <algorithm>

namespace tet_line_tracker {

void sortTrajectory(std::vector<StampedPose>& trajectory) {
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  trajectory.erase(std::unique(trajectory.begin(), trajectory.end(),
                               [](const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; }),
                   trajectory.end());
}

std::optional<Eigen::Isometry3d> interpolate(const std::vector<StampedPose>& trajectory,
                                             const ros::Time& stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& p, const ros::Time& t) { return p.stamp < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  const double gap_s = (after->stamp - before->stamp).toSec();
  if (gap_s > kMaxPoseGapS) return std::nullopt;
  const double fraction = (stamp - before->stamp).toSec() / gap_s;
  const Eigen::Vector3d position =
      (1.0 - fraction) * before->pose.translation() + fraction * after->pose.translation();
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(before->pose.linear()).slerp(fraction, Eigen::Quaterniond(after->pose.linear()));
  return Eigen::Translation3d(position) * rotation;
}

}  // namespace tet_line_tracker
