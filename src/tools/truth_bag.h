#pragma once

#include <memory>
#include <string>

#include <rosbag/bag.h>

#include "../evaluation/pose_track.h"
#include "../evaluation/truth.h"

namespace tet_line_tracker {

/// What a bag knows of the world.
struct BagTruth {
  std::unique_ptr<Truth> truth;  ///< nullptr: nothing to judge by
  std::string kind;              ///< "scene", "depth", "poses" or "none"
  /// For the three-view error: the camera and its poses; nullptr and empty where either is missing.
  std::shared_ptr<const CameraModel> camera{};
  PoseTrack world_from_camera{};
};

/// Reads the exact scene of simulate_bag, else depth images with poses, else poses alone, else nothing.
/// Throws std::runtime_error when a part is there but cannot be used.
BagTruth readTruth(const rosbag::Bag& bag);

}  // namespace tet_line_tracker
