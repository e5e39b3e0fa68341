#include "world.h"

#include <cmath>
#include <stdexcept>

#include "decorations.h"
#include "street.h"
#include "world_builder.h"

namespace tet_line_tracker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

BrickPattern bricks(RandomSequence& random, float gray, float joint_gray) {
  BrickPattern pattern;
  pattern.gray = gray;
  pattern.joint_gray = joint_gray;
  pattern.seed = random.bits();
  return pattern;
}

BrickPattern tiles(RandomSequence& random, float side, float gray, float joint_gray) {
  BrickPattern pattern = bricks(random, gray, joint_gray);
  pattern.length = side;
  pattern.height = side;
  pattern.shift = 0.0F;
  pattern.gray_spread = 3.0F;
  pattern.joint = 0.008F;
  return pattern;
}

BrickPattern planks(RandomSequence& random) {
  BrickPattern pattern = bricks(random, 105.0F, 60.0F);
  pattern.length = 1.6F;
  pattern.height = 0.16F;
  pattern.shift = 0.37F;
  pattern.gray_spread = 9.0F;
  pattern.joint = 0.006F;
  return pattern;
}

/// Floor (boards along x) and ceiling (panels) of a room from `low` to `high`.
void addFloorAndCeiling(WorldBuilder& builder, const Vector2d& low, const Vector2d& high, double height,
                        const BrickPattern& floor, const BrickPattern& ceiling, float grain,
                        const WorldBuilder::Decoration& decorate_ceiling = {}) {
  const Vector2d size = high - low;
  builder.addRectangle(
      {{low.x(), low.y(), 0.0}, Vector3d::UnitX(), Vector3d::UnitY(), size.x(), size.y(), -1}, 0.0F, grain,
      [&](Texture& t) { t.setBricks(floor); });
  builder.addRectangle(
      {{low.x(), high.y(), height}, Vector3d::UnitX(), -Vector3d::UnitY(), size.x(), size.y(), -1}, 0.0F,
      grain, [&](Texture& t) {
        t.setBricks(ceiling);
        if (decorate_ceiling) decorate_ceiling(t);
      });
}

void addTable(WorldBuilder& builder, const Vector3d& foot, double yaw) {
  const Vector3d top(1.4, 0.7, 0.05);
  builder.addBox(foot + Vector3d(0.0, 0.0, 0.70), top, yaw, WorldBuilder::kAllFaces, 135.0F, 4.0F);
  const Eigen::Rotation2Dd turn(yaw);
  for (const double x : {-0.62, 0.62}) {
    for (const double y : {-0.28, 0.28}) {
      const Vector2d leg = turn * Vector2d(x, y);
      builder.addBox(foot + Vector3d(leg.x(), leg.y(), 0.0), {0.06, 0.06, 0.70}, yaw, WorldBuilder::kSides,
                     70.0F, 2.0F);
    }
  }
}

void addCrate(WorldBuilder& builder, const WorldOptions& options, const Vector3d& centre,
              const Vector3d& swing) {
  MovingBody body;
  body.origin_ns = options.motion_origin_ns;
  body.centre = centre;
  body.swing = swing;
  body.swing_period_s = 5.0;
  body.turn_rad = 0.5;
  body.turn_period_s = 7.0;
  const int number = builder.world().geometry.addBody(body);
  builder.addBox(
      {0.0, 0.0, -0.3}, {0.6, 0.6, 0.6}, 0.3, WorldBuilder::kAllFaces, 140.0F, 4.0F,
      [&](Texture& t) { paintCrate(t, builder.random()); }, number);
}

World makeRoom(const WorldOptions& options) {
  WorldBuilder builder(options.seed);
  RandomSequence& random = builder.random();
  constexpr double kX = 4.5;
  constexpr double kY = 3.5;
  constexpr double kHeight = 3.2;
  addFloorAndCeiling(builder, {-kX, -kY}, {kX, kY}, kHeight, planks(random),
                     tiles(random, 0.75F, 175.0F, 160.0F), 3.0F);

  builder.addWall({kX, kY}, {kX, -kY}, kHeight, 0.0F, 4.0F, [&](Texture& t) {
    t.setBricks(bricks(random, 115.0F, 175.0F));
    paintDoor(t, random, 0.8F);
    paintPoster(t, random, 2.6F, 1.0F, 0.8F, 1.1F);
    paintPoster(t, random, 4.6F, 1.2F, 1.4F, 1.0F);
  });
  builder.addWall({-kX, -kY}, {-kX, kY}, kHeight, 0.0F, 4.0F, [&](Texture& t) {
    t.setBricks(bricks(random, 90.0F, 130.0F));
    t.paint({0.0F, 1.0F, t.width(), t.height(), 165.0F});
    t.paint({0.0F, 1.0F, t.width(), 1.06F, 110.0F});
    paintWindow(t, random, 0.9F, 1.25F, 1.5F, 1.3F);
    paintWindow(t, random, 4.4F, 1.25F, 1.5F, 1.3F);
    paintPoster(t, random, 3.0F, 1.3F, 0.7F, 1.0F);
  });
  builder.addWall({-kX, kY}, {kX, kY}, kHeight, 150.0F, 5.0F, [&](Texture& t) {
    paintSkirting(t, 95.0F);
    paintPoster(t, random, 0.7F, 1.1F, 0.9F, 1.2F);
    paintPoster(t, random, 2.0F, 1.4F, 0.7F, 0.5F);
    paintDoor(t, random, 3.2F);
    paintPoster(t, random, 4.6F, 1.2F, 1.3F, 0.9F);
    paintPoster(t, random, 6.2F, 1.6F, 0.6F, 0.8F);
  });
  builder.addWall({kX, -kY}, {-kX, -kY}, kHeight, 140.0F, options.bare_wall ? 0.8F : 5.0F, [&](Texture& t) {
    paintSkirting(t, 80.0F);
    paintDoor(t, random, 0.5F);
    paintPoster(t, random, 7.6F, 1.0F, 0.9F, 1.3F);
    if (options.bare_wall) return;
    paintWindow(t, random, 2.2F, 1.2F, 1.3F, 1.4F);
    paintPoster(t, random, 4.2F, 1.1F, 1.0F, 1.3F);
    paintPoster(t, random, 5.9F, 1.3F, 0.8F, 0.6F);
  });

  for (const double x : {-2.4, 0.1, 2.6}) {
    builder.addBox({x, 0.0, kHeight - 0.22}, {0.2, 2.0 * kY, 0.22}, 0.0,
                   WorldBuilder::kLeft | WorldBuilder::kRight | WorldBuilder::kBottom, 95.0F, 4.0F);
  }
  builder.addBox({kX - 0.28, -kY + 0.28, 0.0}, {0.4, 0.4, kHeight}, 0.0, WorldBuilder::kSides, 155.0F, 4.0F);
  builder.addBox({-kX + 0.28, kY - 0.28, 0.0}, {0.4, 0.4, kHeight}, 0.0, WorldBuilder::kSides, 120.0F, 4.0F);

  builder.addBox({3.2, 3.25, 0.0}, {1.1, 0.36, 1.9}, 0.0, WorldBuilder::kSides | WorldBuilder::kTop, 100.0F,
                 3.0F, [&](Texture& t) { paintShelf(t, random, 5); });
  addTable(builder, {-3.2, 0.3, 0.0}, 1.45);
  const auto parcel = [&](double x, double y, double z, double size) {
    builder.addBox(
        {x, y, z},
        {size * random.uniform(0.8, 1.2), size * random.uniform(0.8, 1.2), size * random.uniform(0.7, 1.0)},
        random.uniform(-0.6, 0.6), WorldBuilder::kSides | WorldBuilder::kTop,
        static_cast<float>(random.uniform(90.0, 150.0)), 4.0F, [&](Texture& t) { paintParcel(t, random); });
  };
  parcel(3.6, 0.8, 0.0, 0.7);
  parcel(3.5, -1.4, 0.0, 0.5);
  parcel(-3.3, 2.3, 0.0, 0.6);
  parcel(-3.4, -2.3, 0.0, 0.8);
  parcel(-0.8, 2.9, 0.0, 0.6);
  parcel(1.6, -2.9, 0.0, 0.5);
  parcel(-3.2, 0.5, 0.751, 0.3);

  if (options.moving_object) addCrate(builder, options, {2.9, 0.0, 1.5}, {0.0, 1.6, 0.2});
  // Last, so that the rest of the room is the same with and without.
  addDistractors(builder, options.distractors, options.motion_origin_ns);
  World world = builder.finish();
  world.free_centre = {0.0, 0.0, 1.55};
  world.free_half_extent = {1.6, 1.2, 0.35};
  world.bare_wall_view = {0.0, -kY + 1.2, 1.55};
  world.bare_wall_yaw = -0.5 * M_PI;
  return world;
}

World makeCorridor(const WorldOptions& options) {
  WorldBuilder builder(options.seed);
  RandomSequence& random = builder.random();
  const double length = options.corridor_length;
  constexpr double kY = 1.2;
  constexpr double kHeight = 2.7;
  const double middle = 0.5 * (length - 6.0);
  const auto bare = [&](double x) { return options.bare_wall && std::abs(x - middle) < 3.2; };

  addFloorAndCeiling(builder, {0.0, -kY}, {length, kY}, kHeight, tiles(random, 0.5F, 95.0F, 120.0F),
                     tiles(random, 0.6F, 160.0F, 148.0F), 3.0F, [&](Texture& t) {
                       for (float x = 1.8F; x + 1.2F < t.width(); x += 3.0F)
                         t.paint({x, 1.05F, x + 1.1F, 1.35F, 228.0F});
                     });
  builder.addWall({0.0, kY}, {length, kY}, kHeight, 0.0F, 4.0F, [&](Texture& t) {
    t.setBricks(bricks(random, 110.0F, 165.0F));
    t.paint({0.0F, 1.2F, t.width(), t.height(), 160.0F});
    t.paint({0.0F, 1.2F, t.width(), 1.25F, 90.0F});
    for (float x = 1.0F; x + 3.5F < t.width(); x += 4.2F) {
      paintDoor(t, random, x);
      paintPoster(t, random, x + 1.7F, 1.35F, static_cast<float>(random.uniform(0.5, 0.9)), 0.8F);
    }
  });
  builder.addWall(
      {length, -kY}, {0.0, -kY}, kHeight, 145.0F, options.bare_wall ? 0.8F : 5.0F, [&](Texture& t) {
        paintSkirting(t, 85.0F);
        for (float u = 1.5F; u + 3.5F < t.width(); u += 4.6F) {
          const double x = length - u;
          if (!bare(x)) paintWindow(t, random, u, 0.95F, 1.2F, 1.2F);
          if (!bare(x - 2.0)) {
            paintPoster(t, random, u + 2.0F, 1.0F, static_cast<float>(random.uniform(0.6, 1.1)), 0.9F);
          }
        }
      });
  builder.addWall({length, kY}, {length, -kY}, kHeight, 120.0F, 4.0F,
                  [&](Texture& t) { paintDoor(t, random, 0.7F); });
  builder.addWall({0.0, -kY}, {0.0, kY}, kHeight, 130.0F, 4.0F,
                  [&](Texture& t) { paintDoor(t, random, 0.7F); });

  for (double x = 3.6; x < length - 1.0; x += 3.0) {
    builder.addBox({x, 0.0, kHeight - 0.18}, {0.16, 2.0 * kY, 0.18}, 0.0,
                   WorldBuilder::kLeft | WorldBuilder::kRight | WorldBuilder::kBottom, 105.0F, 4.0F);
  }
  for (double x = 4.9; x < length - 1.0; x += 8.4) {
    // The back lies in the wall.
    builder.addBox({x, kY - 0.09, 0.0}, {0.3, 0.18, kHeight}, 0.0,
                   WorldBuilder::kLeft | WorldBuilder::kRight | WorldBuilder::kFront, 135.0F, 4.0F);
  }
  for (double x = 6.5; x < length - 1.0; x += 6.9) {
    if (bare(x)) continue;
    const double size = random.uniform(0.3, 0.45);
    builder.addBox({x, -kY + 0.4, 0.0}, {size, size, random.uniform(0.3, 0.6)}, random.uniform(-0.4, 0.4),
                   WorldBuilder::kSides | WorldBuilder::kTop, static_cast<float>(random.uniform(80.0, 150.0)),
                   4.0F, [&](Texture& t) { paintParcel(t, random); });
  }
  if (options.moving_object) {
    addCrate(builder, options, {length - 3.5, 0.0, 1.3}, {1.2, 0.3, 0.2});
  }
  World world = builder.finish();
  world.free_centre = {middle, 0.0, 1.4};
  world.free_half_extent = {1.5, 0.3, 0.2};
  world.bare_wall_view = {middle, 0.1, 1.35};
  world.bare_wall_yaw = -0.5 * M_PI;
  return world;
}

World makeEmptyRoom(const WorldOptions& options) {
  WorldBuilder builder(options.seed);
  RandomSequence& random = builder.random();
  constexpr double kX = 3.2;
  constexpr double kY = 2.7;
  constexpr double kHeight = 2.8;
  constexpr float kGrain = 2.0F;
  addFloorAndCeiling(builder, {-kX, -kY}, {kX, kY}, kHeight, tiles(random, 1.2F, 120.0F, 108.0F),
                     tiles(random, 20.0F, 180.0F, 180.0F), kGrain);
  builder.addWall({kX, kY}, {kX, -kY}, kHeight, 150.0F, kGrain, [&](Texture& t) {
    paintSkirting(t, 132.0F);
    paintDoor(t, random, 2.2F);
  });
  builder.addWall({-kX, -kY}, {-kX, kY}, kHeight, 155.0F, kGrain, [&](Texture& t) {
    paintSkirting(t, 135.0F);
    paintWindow(t, random, 2.0F, 1.0F, 1.3F, 1.2F);
  });
  builder.addWall({-kX, kY}, {kX, kY}, kHeight, 148.0F, kGrain,
                  [&](Texture& t) { paintSkirting(t, 132.0F); });
  builder.addWall({kX, -kY}, {-kX, -kY}, kHeight, 146.0F, options.bare_wall ? 0.8F : kGrain,
                  [&](Texture& t) { paintSkirting(t, 132.0F); });
  if (options.moving_object) addCrate(builder, options, {2.2, 0.0, 1.3}, {0.0, 1.2, 0.2});
  World world = builder.finish();
  world.free_centre = {-0.2, 0.0, 1.4};
  world.free_half_extent = {1.2, 1.0, 0.3};
  world.bare_wall_view = {0.0, -kY + 1.2, 1.4};
  world.bare_wall_yaw = -0.5 * M_PI;
  return world;
}

}  // namespace

const Texture& World::textureAt(int surface, std::int64_t stamp_ns) const {
  for (const Screen& screen : screens) {
    if (screen.surface != surface) continue;
    const auto count = static_cast<std::int64_t>(screen.pictures.size());
    const std::int64_t number = stamp_ns / screen.period_ns % count;
    return screen.pictures[static_cast<std::size_t>(number < 0 ? number + count : number)];
  }
  return textures[static_cast<std::size_t>(surface)];
}

World makeWorld(const WorldOptions& options) {
  if (options.scene != "room" && options.distractors.text() != "none") {
    throw std::invalid_argument("distractors are " + options.distractors.text() + ", needs scene room, not " +
                                options.scene);
  }
  if (options.scene == "room") return makeRoom(options);
  if (options.scene == "corridor") return makeCorridor(options);
  if (options.scene == "empty") return makeEmptyRoom(options);
  if (options.scene == "street") return makeStreet(options);
  throw std::invalid_argument("scene \"" + options.scene +
                              "\" is not known; known: room, corridor, empty, street");
}

}  // namespace tet_line_tracker
