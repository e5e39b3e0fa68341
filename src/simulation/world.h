#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "distractors.h"
#include "scene_geometry.h"
#include "texture.h"

namespace tet_line_tracker {

/// A still surface that shows what is before it, over its own texture.
struct Mirror {
  int surface;
  float share;  ///< of the light that it reflects, 0..1
};

/// A surface that shows one picture after the other, again and again.
struct Screen {
  int surface;
  std::int64_t period_ns;         ///< of one picture
  std::vector<Texture> pictures;  ///< at least one
};

/// A simulated world: z is up, lengths in metres.
struct World {
  SceneGeometry geometry;
  std::vector<Texture> textures;  ///< one per rectangle of the geometry
  std::vector<Mirror> mirrors;
  std::vector<Screen> screens;

  /// A box in which a camera meets nothing.
  Eigen::Vector3d free_centre;
  Eigen::Vector3d free_half_extent;

  /// From where, and in which direction about z [rad], a camera that looks level sees a bare wall alone
  /// (when the world was asked to have one).
  Eigen::Vector3d bare_wall_view;
  double bare_wall_yaw{0.0};

  /// How a surface looks at a time, but for what it reflects.
  const Texture& textureAt(int surface, std::int64_t stamp_ns) const;

  /// Gray of a point of a surface, mean over a square of `side` around it [m].
  float gray(const SurfacePoint& point, float side) const {
    const PixelWeight weight = PixelWeight::box(0.5F * side);
    return textures[static_cast<std::size_t>(point.surface)].gray(
        static_cast<float>(point.position.x()), static_cast<float>(point.position.y()), weight, weight);
  }
};

struct WorldOptions {
  std::string scene{"room"};         ///< room, corridor, empty, street
  std::uint64_t seed{1};             ///< grays, sizes and places
  double corridor_length{34.0};      ///< [m]
  double street_length{300.0};       ///< [m]
  bool bare_wall{false};             ///< leave a stretch of wall bare, for bare_wall_view
  bool moving_object{false};         ///< a crate that swings to and fro
  Distractors distractors;           ///< in scene room
  std::int64_t motion_origin_ns{0};  ///< stamp at which the crate is in the middle
};

/// Throws std::invalid_argument for an unknown scene, and for what it cannot have.
World makeWorld(const WorldOptions& options);

}  // namespace tet_line_tracker
