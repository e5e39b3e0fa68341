#include "pose_track.h"

#include <algorithm>

namespace tet_line_tracker {

void PoseTrack::add(std::int64_t stamp_ns, const Eigen::Isometry3d& world_from_body) {
  poses_.push_back({stamp_ns, world_from_body.translation(), Eigen::Quaterniond(world_from_body.linear())});
}

void PoseTrack::sort() {
  std::sort(poses_.begin(), poses_.end(),
            [](const Pose& a, const Pose& b) { return a.stamp_ns < b.stamp_ns; });
}

std::optional<Eigen::Isometry3d> PoseTrack::at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), stamp_ns,
                       [](const Pose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  if (after == poses_.end()) return std::nullopt;
  const auto assemble = [](const Eigen::Quaterniond& rotation, const Eigen::Vector3d& position) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = position;
    return pose;
  };
  if (after->stamp_ns == stamp_ns) return assemble(after->rotation, after->position);
  if (after == poses_.begin()) return std::nullopt;
  const auto before = after - 1;
  const std::int64_t gap = after->stamp_ns - before->stamp_ns;
  if (gap > max_gap_ns) return std::nullopt;
  const double fraction = static_cast<double>(stamp_ns - before->stamp_ns) / static_cast<double>(gap);
  return assemble(before->rotation.slerp(fraction, after->rotation),
                  before->position + fraction * (after->position - before->position));
}

}  // namespace tet_line_tracker
