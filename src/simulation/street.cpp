#include "street.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "decorations.h"
#include "road_curve.h"
#include "world_builder.h"

namespace tet_line_tracker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStart = -30.0;        // x of the street's beginning [m]
constexpr double kKerb = 5.6;           // from the centre line [m]
constexpr double kSidewalkWidth = 2.4;  // [m]
constexpr double kParking = 4.55;       // middle of the parked cars [m]
constexpr float kNoGrain = 0.0F;

/// Builds one street; side is +1 on the left and -1 on the right of who drives along x.
class Street {
 public:
  explicit Street(const WorldOptions& options)
      : builder_(options.seed), road_(options.seed), end_(kStart + options.street_length) {
    addGroundAndSky();
    addLaneMarks();
    for (const double side : {-1.0, 1.0}) {
      addSidewalk(side);
      addHouses(side);
      addPoles(side);
      addParkedCars(side);
      addTrees(side);
    }
  }

  World finish() { return builder_.finish(); }

 private:
  float between(double low, double high) { return static_cast<float>(builder_.random().uniform(low, high)); }
  Vector3d place(double x, double left, double z = 0.0) const {
    const Vector2d p = road_.beside(x, left);
    return {p.x(), p.y(), z};
  }

  void addGroundAndSky() {
    constexpr double kFar = 400.0;  // [m]
    builder_.addRectangle({{kStart - kFar, -kFar, 0.0},
                           Vector3d::UnitX(),
                           Vector3d::UnitY(),
                           end_ - kStart + 2.0 * kFar,
                           2.0 * kFar,
                           -1},
                          92.0F, 6.0F);
    // A box of sky around all: its faces have one light, so that no edge shows between them.
    const auto even = [](Texture& t) { t.setLight(1.0F, 0.0F, 0.0F); };
    const Vector3d middle(0.5 * (kStart + end_), 0.0, -1.0);
    builder_.addBox(middle, {end_ - kStart + 2.0 * kFar, 2.0 * kFar, kFar}, 0.0,
                    WorldBuilder::kSides | WorldBuilder::kTop, 235.0F, kNoGrain, even);
  }

  /// A strip that lies on the road at `height`, small enough to be straight.
  void addStrip(double x, double left, double length, double width, float gray, double height) {
    const double angle = road_.heading(x);
    const Vector3d u(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d v(-std::sin(angle), std::cos(angle), 0.0);
    builder_.addRectangle(
        {place(x, left, height) - 0.5 * length * u - 0.5 * width * v, u, v, length, width, -1}, gray, 5.0F);
  }

  void addLaneMarks() {
    for (double x = kStart; x < end_; x += 6.0) addStrip(x, 0.0, 3.0, 0.13, 205.0F, 0.006);
    for (double x = kStart + 4.0; x < end_; x += 13.0) {  // repaired asphalt, manholes
      addStrip(x, between(-3.0, 3.0), between(1.0, 4.0), between(0.6, 1.6), between(65.0, 110.0), 0.003);
    }
    for (double x = kStart + 35.0; x < end_; x += 63.0) {  // zebra crossings
      for (double left = -3.0; left <= 3.0; left += 1.0) addStrip(x, left, 3.0, 0.5, 210.0F, 0.005);
    }
  }

  void addSidewalk(double side) {
    constexpr double kPiece = 6.0;
    BrickPattern pavers;
    pavers.length = 0.75F;
    pavers.height = 0.60F;
    pavers.joint = 0.012F;
    pavers.shift = 0.0F;
    pavers.gray_spread = 5.0F;
    int number = 0;
    for (double x = kStart; x < end_; x += kPiece) {
      pavers.gray = between(118.0, 135.0);
      pavers.joint_gray = pavers.gray - 35.0F;
      pavers.seed = builder_.random().bits();
      // Pieces overlap in the bends, where two heights keep them apart.
      const double height = number++ % 2 == 0 ? 0.120 : 0.126;
      const double angle = road_.heading(x);
      const Vector3d foot = place(x, side * (kKerb + 0.5 * kSidewalkWidth));
      const double length = kPiece / std::cos(angle) * 1.03;
      builder_.addBox(foot, {length, kSidewalkWidth, height}, angle, WorldBuilder::kTop, 125.0F, 5.0F,
                      [&](Texture& t) { t.setBricks(pavers); });
      builder_.addBox(foot, {length, kSidewalkWidth, height}, angle,
                      side > 0.0 ? WorldBuilder::kFront : WorldBuilder::kBack, 165.0F, 5.0F);
    }
  }

  void decorateFacade(Texture& t, int style, float wall) {
    RandomSequence& random = builder_.random();
    if (style == 0) {  // ashlar
      BrickPattern blocks;
      blocks.length = 1.1F;
      blocks.height = 0.5F;
      blocks.joint = 0.02F;
      blocks.gray = wall;
      blocks.joint_gray = wall - 30.0F;
      blocks.gray_spread = 5.0F;
      blocks.seed = random.bits();
      t.setBricks(blocks);
    }
    t.paint({0.0F, 0.0F, t.width(), 0.6F, wall - 35.0F});
    constexpr float kFloor = 3.0F;
    const float step = between(1.9, 3.2);
    const float width = step * between(0.45, 0.6);
    const float first = 0.5F * (t.width() - step * std::floor((t.width() - 0.8F) / step));
    const bool shop = style == 2;
    const float door = first + step * static_cast<float>(random.below(3));
    for (int floor = 0; static_cast<float>(floor + 1) * kFloor <= t.height() + 0.01F; ++floor) {
      const float bottom = static_cast<float>(floor) * kFloor;
      if (floor > 0 && style != 1) t.paint({0.0F, bottom, t.width(), bottom + 0.15F, wall + 22.0F});
      if (floor == 0 && shop) {
        t.paint({0.5F, 0.5F, t.width() - 0.5F, 2.4F, between(35.0, 75.0)});
        t.paint({0.4F, 2.45F, t.width() - 0.4F, 2.95F, between(60.0, 220.0)});
        for (float u = 2.5F; u + 1.0F < t.width(); u += 2.5F) t.paint({u, 0.5F, u + 0.08F, 2.4F, 150.0F});
        continue;
      }
      for (float u = first; u + width < t.width() - 0.3F; u += step) {
        if (floor == 0 && u == door) {
          paintDoor(t, random, u);
        } else if (style == 1) {  // plain panes in a light frame
          t.paint({u, bottom + 0.9F, u + width, bottom + 2.4F, wall + 35.0F});
          t.paint({u + 0.08F, bottom + 0.98F, u + width - 0.08F, bottom + 2.32F, between(25.0, 70.0)});
        } else {
          const float sill = bottom + 0.85F;
          t.paint({u - 0.12F, sill - 0.10F, u + width + 0.12F, sill, wall + 30.0F});
          t.paint({u, sill, u + width, sill + 1.6F, between(150.0, 220.0)});
          const float middle = u + 0.5F * width;
          const float pane = between(25.0, 80.0);
          t.paint({u + 0.07F, sill + 0.07F, middle - 0.04F, sill + 1.05F, pane});
          t.paint({middle + 0.04F, sill + 0.07F, u + width - 0.07F, sill + 1.05F, pane});
          t.paint({u + 0.07F, sill + 1.13F, u + width - 0.07F, sill + 1.53F, pane + 12.0F});
        }
      }
    }
  }

  void addHouses(double side) {
    RandomSequence& random = builder_.random();
    const unsigned street_face = side > 0.0 ? WorldBuilder::kFront : WorldBuilder::kBack;
    double x = kStart + random.uniform(0.0, 4.0);
    while (x < end_) {
      const double width = random.uniform(8.0, 14.0);
      const double along = width * std::cos(road_.heading(x));
      const double middle = x + 0.5 * along;
      const double angle = road_.heading(middle);
      const double front = kKerb + kSidewalkWidth + random.uniform(0.0, 2.5);
      constexpr double kDepth = 9.0;
      const double height = 3.0 * (2 + random.below(3)) + 0.4;
      const float wall = between(80.0, 170.0);
      const int style = random.below(3);
      builder_.addBox(place(middle, side * (front + 0.5 * kDepth)), {width, kDepth, height}, angle,
                      street_face | WorldBuilder::kLeft | WorldBuilder::kRight, wall, 5.0F,
                      [&](Texture& t) { decorateFacade(t, style, wall); });
      builder_.addBox(place(middle, side * (front + 0.5 * kDepth), height), {width + 0.5, kDepth + 0.9, 0.35},
                      angle, street_face | WorldBuilder::kLeft | WorldBuilder::kRight | WorldBuilder::kBottom,
                      wall - 30.0F, 4.0F);
      x += along;
      if (random.below(3) == 0) {
        const double gap = random.uniform(4.0, 9.0);
        addFence(side, x, gap, kKerb + kSidewalkWidth + 0.3);
        x += gap * std::cos(road_.heading(x));
      }
    }
  }

  void addFence(double side, double x, double length, double left) {
    const double middle = x + 0.5 * length * std::cos(road_.heading(x));
    const bool pickets = builder_.random().below(2) == 0;
    const float dark = between(40.0, 80.0);
    builder_.addBox(place(middle, side * left), {length, 0.15, 1.3}, road_.heading(middle),
                    WorldBuilder::kSides | WorldBuilder::kTop, pickets ? dark : 140.0F, 6.0F,
                    [&](Texture& t) {
                      if (!pickets || t.width() < 1.0F || t.height() < 1.0F) return;
                      for (float u = 0.05F; u + 0.10F < t.width(); u += 0.18F) {
                        t.paint({u, 0.05F, u + 0.10F, 1.2F, 190.0F});
                      }
                      t.paint({0.0F, 0.3F, t.width(), 0.4F, 175.0F});
                      t.paint({0.0F, 0.95F, t.width(), 1.05F, 175.0F});
                    });
  }

  void addPoles(double side) {
    RandomSequence& random = builder_.random();
    for (double x = kStart + random.uniform(2.0, 12.0); x < end_; x += random.uniform(14.0, 20.0)) {
      const double angle = road_.heading(x);
      const double left = side * (kKerb + 0.35);
      const float gray = between(45.0, 150.0);
      builder_.addBox(place(x, left), {0.14, 0.14, 6.0}, angle, WorldBuilder::kSides, gray, 4.0F);
      builder_.addBox(place(x, left - side * 0.72, 5.9), {0.10, 1.4, 0.10}, angle, WorldBuilder::kAllFaces,
                      gray, 4.0F);
    }
    for (double x = kStart + random.uniform(0.0, 9.0); x < end_; x += random.uniform(9.0, 30.0)) {  // signs
      const double angle = road_.heading(x) + random.uniform(-0.2, 0.2);
      const double left = side * (kKerb + 0.45);
      builder_.addBox(place(x, left), {0.07, 0.07, 2.3}, angle, WorldBuilder::kSides, 150.0F, 3.0F);
      builder_.addBox(place(x, left, 2.3), {0.03, 0.6, between(0.5, 0.9)}, angle, WorldBuilder::kAllFaces,
                      between(60.0, 220.0), 3.0F, [&](Texture& t) {
                        if (t.width() < 0.3F || t.height() < 0.3F) return;
                        t.paint({0.05F, 0.05F, t.width() - 0.05F, t.height() - 0.05F, between(190.0, 230.0)});
                        t.paint({0.15F, 0.18F, t.width() - 0.15F, 0.28F, 40.0F});
                        t.paint({0.27F, 0.28F, 0.33F, t.height() - 0.12F, 40.0F});
                      });
    }
    for (double x = kStart + random.uniform(10.0, 30.0); x < end_; x += random.uniform(35.0, 60.0)) {
      for (int i = 0; i < 5; ++i) {  // bollards
        const double at = x + 1.5 * i;
        builder_.addBox(place(at, side * (kKerb + 0.2)), {0.13, 0.13, 0.95}, road_.heading(at),
                        WorldBuilder::kSides | WorldBuilder::kTop, 70.0F, 4.0F, [](Texture& t) {
                          if (t.height() > 0.5F) t.paint({0.0F, 0.70F, t.width(), 0.80F, 215.0F});
                        });
      }
    }
  }

  void addParkedCars(double side) {
    RandomSequence& random = builder_.random();
    for (double x = kStart + random.uniform(0.0, 6.0); x < end_; x += random.uniform(5.6, 6.6)) {
      const int kind = random.below(8);
      if (kind > 5) continue;  // a free place
      const double angle = road_.heading(x) + random.uniform(-0.03, 0.03);
      const double left = side * (kParking + random.uniform(-0.1, 0.1));
      const float paint = between(30.0, 215.0);
      if (kind == 5) {
        addVan(place(x, left), angle, paint);
      } else {
        addCar(place(x, left), angle, paint);
      }
    }
  }

  static void paintWheels(Texture& t) {
    if (t.width() < 3.0F) return;
    for (const float u : {0.55F, t.width() - 1.15F}) {
      t.paint({u, 0.0F, u + 0.60F, 0.50F, 22.0F});
      t.paint({u + 0.18F, 0.10F, u + 0.42F, 0.36F, 150.0F});
    }
  }

  void addCar(const Vector3d& foot, double angle, float paint) {
    constexpr unsigned kFaces = WorldBuilder::kSides | WorldBuilder::kTop;
    const double length = builder_.random().uniform(3.8, 4.5);
    builder_.addBox(foot + Vector3d(0.0, 0.0, 0.12), {length, 1.7, 0.78}, angle, kFaces, paint, 2.0F,
                    [&](Texture& t) {
                      if (t.height() > 1.0F) return;  // the bonnet
                      t.paint({0.0F, 0.0F, t.width(), 0.12F, 30.0F});
                      paintWheels(t);
                      if (t.width() > 3.0F) {
                        for (const float u : {0.33F, 0.58F}) {  // doors
                          t.paint({u * t.width(), 0.14F, u * t.width() + 0.02F, 0.78F, paint - 25.0F});
                        }
                      } else {
                        t.paint({0.08F, 0.45F, 0.40F, 0.60F, 235.0F});
                        t.paint({t.width() - 0.40F, 0.45F, t.width() - 0.08F, 0.60F, 235.0F});
                        t.paint({0.60F, 0.18F, 1.12F, 0.30F, 225.0F});
                      }
                    });
    builder_.addBox(foot + Vector3d(0.0, 0.0, 0.90), {0.55 * length, 1.5, 0.55}, angle, kFaces, paint, 2.0F,
                    [&](Texture& t) {
                      if (t.height() > 1.0F) return;  // the roof
                      t.paint({0.08F, 0.05F, t.width() - 0.08F, 0.47F, 35.0F});
                      if (t.width() > 1.8F) {
                        t.paint({0.5F * t.width() - 0.04F, 0.05F, 0.5F * t.width() + 0.04F, 0.47F, paint});
                      }
                    });
  }

  void addVan(const Vector3d& foot, double angle, float paint) {
    builder_.addBox(foot + Vector3d(0.0, 0.0, 0.15), {5.2, 1.9, 2.1}, angle,
                    WorldBuilder::kSides | WorldBuilder::kTop, paint, 2.0F, [&](Texture& t) {
                      if (t.height() < 2.0F) return;
                      t.paint({0.0F, 0.0F, t.width(), 0.15F, 30.0F});
                      paintWheels(t);
                      if (t.width() > 3.0F) {
                        t.paint({0.55F, 1.15F, 1.45F, 1.85F, 35.0F});
                        t.paint({1.6F, 0.2F, 1.62F, 1.95F, paint - 25.0F});
                        t.paint({3.0F, 0.2F, 3.02F, 1.95F, paint - 25.0F});
                        t.paint({1.9F, 1.0F, 4.6F, 1.5F, paint > 120.0F ? 60.0F : 200.0F});
                      } else {
                        t.paint({0.15F, 1.1F, t.width() - 0.15F, 1.85F, 40.0F});
                        t.paint({0.68F, 0.45F, 1.2F, 0.57F, 225.0F});
                      }
                    });
  }

  /// A trunk, and for a crown leaves that stand at all angles: clutter with no long line.
  void addTrees(double side) {
    RandomSequence& random = builder_.random();
    for (double x = kStart + random.uniform(0.0, 15.0); x < end_; x += random.uniform(12.0, 26.0)) {
      const double left = side * (kKerb + 1.0);
      const double height = random.uniform(2.2, 3.0);
      builder_.addBox(place(x, left), {0.26, 0.26, height + 0.8}, random.uniform(0.0, 1.5),
                      WorldBuilder::kSides, 62.0F, 14.0F);
      constexpr int kLeaves = 50;
      for (int i = 0; i < kLeaves; ++i) {
        Vector3d offset(random.normal(), random.normal(), random.normal());
        offset = offset.normalized() * (1.3 * std::cbrt(random.uniform(0.1, 1.0)));
        const Vector3d normal = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
        const Vector3d u = normal.unitOrthogonal();
        const Vector3d v = normal.cross(u);
        const double size = random.uniform(0.2, 0.5);
        builder_.addRectangle({place(x, left, height + 1.3) + offset - 0.5 * size * (u + v), u, v, size,
                               size * random.uniform(0.6, 1.0), -1},
                              between(35.0, 95.0), 12.0F);
      }
    }
  }

  WorldBuilder builder_;
  RoadCurve road_;
  double end_;
};

}  // namespace

World makeStreet(const WorldOptions& options) {
  if (options.bare_wall) throw std::invalid_argument("scene street has no bare wall");
  if (options.moving_object) throw std::invalid_argument("scene street has no moving object");
  World world = Street(options).finish();
  constexpr double kRightLane = -1.75;    // [m]
  constexpr double kCameraHeight = 1.65;  // [m]
  world.free_centre = {0.0, kRightLane, kCameraHeight};
  world.free_half_extent = {0.0, 0.35, 0.02};
  return world;
}

}  // namespace tet_line_tracker
