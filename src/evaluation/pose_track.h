#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace tet_line_tracker {

/// Poses over time, interpolated between neighbours. Const use may be shared between threads.
class PoseTrack {
 public:
  /// A pose later than the ones before, or earlier: the order does not matter.
  void add(std::int64_t stamp_ns, const Eigen::Isometry3d& world_from_body);
  /// Call once after the last add().
  void sort();

  /// Pose at `stamp_ns`; nothing outside the first and last pose, or inside a gap longer than `max_gap_ns`.
  std::optional<Eigen::Isometry3d> at(std::int64_t stamp_ns, std::int64_t max_gap_ns = 200000000) const;

  bool empty() const { return poses_.empty(); }

 private:
  struct Pose {
    std::int64_t stamp_ns;
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };
  std::vector<Pose> poses_;
};

}  // namespace tet_line_tracker
