#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <Eigen/Geometry>

#include "counter_random.h"
#include "world.h"

namespace tet_line_tracker {

/// Puts textured rectangles and boxes into a world, and keeps its true edges.
class WorldBuilder {
 public:
  using Decoration = std::function<void(Texture&)>;

  enum Face : unsigned {
    kLeft = 1U,   // -x of the box
    kRight = 2U,  // +x
    kFront = 4U,  // -y
    kBack = 8U,   // +y
    kBottom = 16U,
    kTop = 32U,
    kSides = kLeft | kRight | kFront | kBack,
    kAllFaces = kSides | kBottom | kTop,
  };

  explicit WorldBuilder(std::uint64_t seed);

  RandomSequence& random() { return random_; }
  World& world() { return world_; }

  /// `gray` of the bare surface, `grain` its deviation in gray levels.
  void addRectangle(const Rectangle& rectangle, float gray, float grain, const Decoration& decorate = {});
  /// Wall of `height` on the floor from `start` to `end`; u runs along it, v up.
  void addWall(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double height, float gray,
               float grain, const Decoration& decorate = {});
  /// Box of `size` whose floor centre is `foot`, turned by `yaw` [rad] about the vertical. Leave faces away
  /// that would lie in another surface.
  void addBox(const Eigen::Vector3d& foot, const Eigen::Vector3d& size, double yaw, unsigned faces,
              float gray, float grain, const Decoration& decorate = {}, int body = -1);

  World finish() { return std::move(world_); }

 private:
  World world_;
  RandomSequence random_;
  std::shared_ptr<const Grain> grain_;
};

}  // namespace tet_line_tracker
