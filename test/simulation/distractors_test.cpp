#include "simulation/distractors.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

World room(const std::string& distractors) {
  WorldOptions options;
  options.distractors = parseDistractors(distractors);
  return makeWorld(options);
}

TEST(Distractors, AreReadByNameAndUnknownOnesRefused) {
  EXPECT_EQ("none", parseDistractors("none").text());
  EXPECT_EQ("round,mirror", parseDistractors("mirror,round").text());
  std::string all;
  for (const std::string& name : distractorNames()) all += (all.empty() ? "" : ",") + name;
  EXPECT_EQ(all, parseDistractors("all").text());
  EXPECT_THROW(parseDistractors("mirrors"), std::invalid_argument);
}

TEST(Distractors, NeedTheRoom) {
  WorldOptions options;
  options.scene = "corridor";
  EXPECT_NO_THROW(makeWorld(options));
  options.distractors.mirror = true;
  EXPECT_THROW(makeWorld(options), std::invalid_argument);
}

TEST(Distractors, AreNamedInTheScene) {
  SimulationOptions options;
  options.seconds = 0.1;
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  EXPECT_EQ(Simulation(options, camera).geometry().toText().find("distractors"), std::string::npos);
  options.distractors = parseDistractors("screen,cables");
  EXPECT_NE(Simulation(options, camera).geometry().toText().find("argument distractors cables,screen\n"),
            std::string::npos);
}

TEST(Distractors, LeaveTheRestOfTheRoomAsItIs) {
  const World bare = room("none");
  const World full = room("all");
  const auto& expected = bare.geometry.rectangles();
  ASSERT_GT(full.geometry.rectangles().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(expected[i].origin, full.geometry.rectangles()[i].origin);
    EXPECT_EQ(bare.gray({static_cast<int>(i), {0.2, 0.3}}, 0.01F),
              full.gray({static_cast<int>(i), {0.2, 0.3}}, 0.01F));
  }
}

TEST(Distractors, HaveNoTrueEdgesButTheirPotsAndFrames) {
  const std::size_t bare = room("none").geometry.edges().size();
  EXPECT_EQ(bare, room("round").geometry.edges().size());
  EXPECT_EQ(bare, room("cables").geometry.edges().size());
  EXPECT_EQ(bare, room("people").geometry.edges().size());
  EXPECT_EQ(bare, room("glossy_floor").geometry.edges().size());
  constexpr std::size_t kPlants = 2;
  constexpr std::size_t kEdgesOfAPot = 5 * 4;
  EXPECT_EQ(bare + kPlants * kEdgesOfAPot, room("foliage").geometry.edges().size());
  constexpr std::size_t kEdgesOfAFrame = 4 * 4;
  EXPECT_EQ(bare + kEdgesOfAFrame, room("mirror").geometry.edges().size());
  EXPECT_EQ(bare + kEdgesOfAFrame, room("screen").geometry.edges().size());
}

TEST(Distractors, StayOutOfTheWayOfTheCamera) {
  const World bare = room("none");
  const World full = room("all");
  constexpr double kNear = 0.15;  // [m]
  const Eigen::Vector3d reach = full.free_half_extent.array() + kNear;
  for (std::size_t i = bare.geometry.rectangles().size(); i < full.geometry.rectangles().size(); ++i) {
    const Rectangle& rectangle = full.geometry.rectangles()[i];
    for (std::int64_t stamp_ns = 0; stamp_ns < 30000000000; stamp_ns += 100000000) {
      for (const double u : {0.0, 0.5, 1.0}) {
        const Eigen::Vector3d point = full.geometry.pointAt(
            {static_cast<int>(i), {u * rectangle.width, 0.5 * rectangle.height}}, stamp_ns);
        const Eigen::Array3d offset = (point - full.free_centre).array().abs();
        EXPECT_FALSE((offset < reach.array()).all()) << nameOf(rectangle.kind) << " at " << point.transpose();
      }
      if (rectangle.body < 0) break;
    }
  }
}

TEST(Distractors, AColumnIsRound) {
  const World world = room("round");
  const Eigen::Vector3d column(2.2, -2.0, 1.5);
  constexpr double kRadius = 0.18;
  for (double around = 0.0; around < 2.0; around += 0.37) {
    const Eigen::Vector3d eye = column + Eigen::Vector3d(-std::cos(around), std::sin(around), 0.0);
    const double expected = std::asin(kRadius / (column - eye).norm());
    const auto isHit = [&](double angle) {
      const Eigen::Vector3d ahead =
          Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * (column - eye).normalized();
      const auto hit = world.geometry.raycast(eye, ahead, 0);
      return hit && world.geometry.rectangles()[static_cast<std::size_t>(hit->point.surface)].kind ==
                        SurfaceKind::kRound;
    };
    // 0.1 px at 458 px.
    EXPECT_TRUE(isHit(expected - 2e-4)) << around;
    EXPECT_FALSE(isHit(expected + 1e-6)) << around;
  }
}

TEST(Distractors, AScreenShowsAnotherPictureEvery400Milliseconds) {
  const World world = room("screen");
  ASSERT_EQ(1U, world.screens.size());
  const int surface = world.screens.front().surface;
  EXPECT_EQ(SurfaceKind::kScreen, world.geometry.rectangles()[static_cast<std::size_t>(surface)].kind);
  const std::int64_t start_ns = 1000000000000;
  const Texture* const first = &world.textureAt(surface, start_ns);
  EXPECT_EQ(first, &world.textureAt(surface, start_ns + 399999999));
  EXPECT_NE(first, &world.textureAt(surface, start_ns + 400000000));
  EXPECT_NO_THROW(world.textureAt(surface, -1));
  EXPECT_EQ(&world.textures[0], &world.textureAt(0, start_ns));
}

}  // namespace
}  // namespace tet_line_tracker
