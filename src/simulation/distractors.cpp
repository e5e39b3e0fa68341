#include "distractors.h"

#include <array>
#include <cmath>

#include "named_flags.h"
#include "world_builder.h"

namespace tet_line_tracker {
namespace {

using Eigen::Vector3d;

constexpr std::array<NamedFlag<Distractors>, 7> kDistractors{{{"round", &Distractors::round},
                                                              {"cables", &Distractors::cables},
                                                              {"foliage", &Distractors::foliage},
                                                              {"people", &Distractors::people},
                                                              {"mirror", &Distractors::mirror},
                                                              {"glossy_floor", &Distractors::glossy_floor},
                                                              {"screen", &Distractors::screen}}};

constexpr float kNoGrain = 0.0F;  // of neighbouring facets it would not fit together

void evenLight(Texture& texture) {
  texture.setLight(1.0F, 0.0F, 0.0F);
}

/// What the facets of a thing have in common.
struct Look {
  SurfaceKind kind;
  float gray;
  int body{-1};
};

/// Light of a lamp on a side that looks along `normal`; smooth, so that no edge shows between facets.
float lightOn(const Vector3d& normal) {
  return static_cast<float>(0.85 + 0.3 * normal.dot(Vector3d(0.5, -0.3, 0.81).normalized()));
}

/// A tube of `facets` around the axis from `start` to `end`. At 2 m and 458 px a radius of 0.2 m in 96 facets
/// is 0.02 px less than round.
void addTube(WorldBuilder& builder, const Vector3d& start, const Vector3d& end, double radius, int facets,
             const Look& look) {
  const Vector3d axis = (end - start).normalized();
  const Vector3d x = axis.unitOrthogonal();
  const Vector3d y = axis.cross(x);
  const auto normalAt = [&](double corner) -> Vector3d {
    const double angle = 2.0 * M_PI * corner / facets;
    return std::cos(angle) * x + std::sin(angle) * y;
  };
  const double width = 2.0 * radius * std::sin(M_PI / facets);
  for (int i = 0; i < facets; ++i) {
    const Vector3d corner = start + radius * normalAt(i);
    const Vector3d along = (normalAt(i + 1) - normalAt(i)).normalized();
    const float first = lightOn(normalAt(i));
    const float last = lightOn(normalAt(i + 1));
    builder.addRectangle({corner, along, axis, width, (end - start).norm(), look.body, look.kind}, look.gray,
                         kNoGrain,
                         [&](Texture& t) { t.setLight(0.5F * (first + last), last - first, 0.0F); });
  }
}

/// A level disc: rectangles around its middle whose short sides are those of a polygon of 48.
void addDisc(WorldBuilder& builder, const Vector3d& middle, double radius, const Look& look) {
  constexpr int kRectangles = 24;
  constexpr double kHalf = 0.5 * M_PI / kRectangles;
  for (int i = 0; i < kRectangles; ++i) {
    const double angle = 2.0 * kHalf * i;
    const Vector3d u(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d v(-std::sin(angle), std::cos(angle), 0.0);
    const double width = 2.0 * radius * std::cos(kHalf);
    const double height = 2.0 * radius * std::sin(kHalf);
    builder.addRectangle(
        {middle - 0.5 * width * u - 0.5 * height * v, u, v, width, height, look.body, look.kind}, look.gray,
        kNoGrain, evenLight);
  }
}

void addRound(WorldBuilder& builder) {
  constexpr int kFacets = 96;
  constexpr double kCeiling = 3.2;
  const Look column{SurfaceKind::kRound, 150.0F};
  addTube(builder, {2.2, -2.0, 0.0}, {2.2, -2.0, kCeiling}, 0.18, kFacets, column);
  addTube(builder, {2.0, 2.1, 0.0}, {2.0, 2.1, kCeiling}, 0.15, kFacets, {SurfaceKind::kRound, 90.0F});
  addTube(builder, {-3.9, 3.3, 2.7}, {4.4, 3.3, 2.7}, 0.06, kFacets, {SurfaceKind::kRound, 110.0F});
  const Vector3d table(2.7, 0.1, 0.0);
  constexpr double kTop = 0.74;
  const Look wood{SurfaceKind::kRound, 165.0F};
  addDisc(builder, table + Vector3d(0.0, 0.0, kTop), 0.45, wood);
  addTube(builder, table + Vector3d(0.0, 0.0, kTop - 0.04), table + Vector3d(0.0, 0.0, kTop - 0.001), 0.449,
          kFacets, {SurfaceKind::kRound, 120.0F});
  addTube(builder, table, table + Vector3d(0.0, 0.0, kTop - 0.04), 0.04, kFacets, wood);
}

/// A tube along a parabola.
void addCable(WorldBuilder& builder, const Vector3d& start, const Vector3d& end, double sag) {
  constexpr int kPieces = 24;
  constexpr int kFacets = 12;
  constexpr double kRadius = 0.012;
  const auto at = [&](int i) -> Vector3d {
    const double s = static_cast<double>(i) / kPieces;
    return start + s * (end - start) - Vector3d(0.0, 0.0, 4.0 * sag * s * (1.0 - s));
  };
  for (int i = 0; i < kPieces; ++i) {
    addTube(builder, at(i), at(i + 1), kRadius, kFacets, {SurfaceKind::kCable, 35.0F});
  }
}

/// A pot with leaves at all angles, which sway together.
void addPlant(WorldBuilder& builder, const Vector3d& foot, std::int64_t origin_ns) {
  constexpr double kPot = 0.4;
  RandomSequence& random = builder.random();
  builder.addBox(foot, {0.32, 0.32, kPot}, random.uniform(-0.6, 0.6),
                 WorldBuilder::kSides | WorldBuilder::kTop, 95.0F, 4.0F);
  MovingBody wind;
  wind.origin_ns = origin_ns;
  wind.centre = foot + Vector3d(0.0, 0.0, kPot + 0.6);
  wind.swing = {0.02, 0.015, 0.0};
  wind.swing_period_s = 2.3;
  wind.turn_rad = 0.04;
  wind.turn_period_s = 3.1;
  const int body = builder.world().geometry.addBody(wind);
  constexpr int kLeaves = 90;
  const auto direction = [&]() -> Vector3d {
    return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  for (int i = 0; i < kLeaves; ++i) {
    const Vector3d middle = direction() * (0.5 * std::cbrt(random.uniform(0.05, 1.0)));
    const Vector3d u = direction();
    const Vector3d v = u.unitOrthogonal();
    const double length = random.uniform(0.08, 0.22);
    const double width = length * random.uniform(0.3, 0.6);
    builder.addRectangle(
        {middle - 0.5 * length * u - 0.5 * width * v, u, v, length, width, body, SurfaceKind::kFoliage},
        static_cast<float>(random.uniform(40.0, 120.0)), 6.0F);
  }
}

/// As stiff as a figure on wheels.
void addPerson(WorldBuilder& builder, const Vector3d& foot, const Vector3d& swing, double period_s,
               std::int64_t origin_ns) {
  MovingBody walk;
  walk.origin_ns = origin_ns;
  walk.centre = foot;
  walk.swing = swing;
  walk.swing_period_s = period_s;
  walk.turn_rad = 0.4;
  walk.turn_period_s = 0.5 * period_s;
  const int body = builder.world().geometry.addBody(walk);
  constexpr int kFacets = 32;
  const auto part = [&](double left, double low, double high, double radius, float gray) {
    const Look look{SurfaceKind::kPerson, gray, body};
    addTube(builder, {0.0, left, low}, {0.0, left, high}, radius, kFacets, look);
    addDisc(builder, {0.0, left, high}, radius, look);
  };
  for (const double side : {-1.0, 1.0}) {
    part(0.10 * side, 0.0, 0.85, 0.085, 50.0F);   // legs
    part(0.25 * side, 0.75, 1.40, 0.05, 175.0F);  // arms
  }
  part(0.0, 0.84, 1.45, 0.19, 190.0F);
  part(0.0, 1.46, 1.75, 0.10, 140.0F);
}

/// A flat thing on a wall with a frame that stands out a little: `middle` of its face, which looks along
/// `normal`. Gives the surface of the face.
int addFramed(WorldBuilder& builder, const Vector3d& middle, const Vector3d& normal, double width,
              double height, float gray, SurfaceKind kind) {
  constexpr double kFrame = 0.05;
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d across = up.cross(normal);
  const auto add = [&](const Vector3d& centre, double w, double h, float shade, SurfaceKind what) {
    builder.addRectangle({centre - 0.5 * w * across - 0.5 * h * up, across, up, w, h, -1, what}, shade, 0.0F,
                         evenLight);
  };
  for (const double side : {-1.0, 1.0}) {
    const Vector3d front = middle + 0.01 * normal;
    add(front + side * 0.5 * (width + kFrame) * across, kFrame, height + 2.0 * kFrame, 60.0F,
        SurfaceKind::kSolid);
    add(front + side * 0.5 * (height + kFrame) * up, width, kFrame, 60.0F, SurfaceKind::kSolid);
  }
  const int face = static_cast<int>(builder.world().geometry.rectangles().size());
  add(middle, width, height, gray, kind);
  return face;
}

void addScreen(WorldBuilder& builder) {
  constexpr double kWidth = 1.4;
  constexpr double kHeight = 0.8;
  constexpr int kPictures = 12;
  Screen screen;
  screen.surface = addFramed(builder, {4.44, -1.7, 1.55}, -Vector3d::UnitX(), kWidth, kHeight, 90.0F,
                             SurfaceKind::kScreen);
  screen.period_ns = 400000000;
  RandomSequence& random = builder.random();
  const auto between = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  for (int i = 0; i < kPictures; ++i) {
    Texture picture(static_cast<float>(kWidth), static_cast<float>(kHeight), between(40.0, 200.0));
    evenLight(picture);
    for (int k = 0; k < 7; ++k) {
      const float u = between(0.0, 1.0);
      const float v = between(0.0, 0.5);
      picture.paint({u, v, u + between(0.15, 0.4), v + between(0.1, 0.3), between(20.0, 235.0)});
    }
    screen.pictures.push_back(picture);
  }
  builder.world().screens.push_back(screen);
}

}  // namespace

std::string Distractors::text() const {
  return flagText(kDistractors, *this);
}

std::vector<std::string> distractorNames() {
  return flagNames(kDistractors);
}

Distractors parseDistractors(const std::string& text) {
  return parseFlags(kDistractors, "distractor", text);
}

void addDistractors(WorldBuilder& builder, const Distractors& distractors, std::int64_t origin_ns) {
  if (distractors.round) addRound(builder);
  if (distractors.cables) {
    addCable(builder, {4.3, 3.0, 2.9}, {4.3, -3.2, 2.9}, 0.6);
    addCable(builder, {-4.2, -2.6, 2.9}, {4.4, -2.6, 2.6}, 0.7);
  }
  if (distractors.foliage) {
    addPlant(builder, {3.7, -0.4, 0.0}, origin_ns);
    addPlant(builder, {2.9, -2.9, 0.0}, origin_ns);
  }
  if (distractors.people) {
    addPerson(builder, {3.1, 0.0, 0.0}, {0.0, 1.5, 0.0}, 6.0, origin_ns);
    addPerson(builder, {1.0, 2.6, 0.0}, {1.2, 0.0, 0.0}, 5.0, origin_ns);
  }
  if (distractors.mirror) {
    const int face =
        addFramed(builder, {0.9, 3.44, 1.6}, -Vector3d::UnitY(), 1.5, 1.3, 60.0F, SurfaceKind::kMirror);
    builder.world().mirrors.push_back({face, 0.85F});
  }
  if (distractors.glossy_floor) {
    // A little above the planks.
    const int floor = static_cast<int>(builder.world().geometry.rectangles().size());
    builder.addRectangle(
        {{-4.5, -3.5, 0.002}, Vector3d::UnitX(), Vector3d::UnitY(), 9.0, 7.0, -1, SurfaceKind::kMirror},
        110.0F, 2.0F);
    builder.world().mirrors.push_back({floor, 0.33F});
  }
  if (distractors.screen) addScreen(builder);
}

}  // namespace tet_line_tracker
