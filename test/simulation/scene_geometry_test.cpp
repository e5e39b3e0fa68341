#include "simulation/scene_geometry.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

/// A wall at x = 4 and a panel at x = 2 that swings along y.
SceneGeometry wallBehindMovingPanel() {
  SceneGeometry scene;
  scene.addArgument("scene", "wall behind panel");
  scene.addArgument("nothing", "");
  MovingBody body;
  body.origin_ns = 1000000000;
  body.centre = {2.0, 0.0, 0.0};
  body.swing = {0.0, 1.0 / 3.0, 0.0};
  body.swing_period_s = 4.0;
  body.turn_rad = 0.1;
  body.turn_period_s = 3.0;
  scene.addBody(body);
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  scene.addRectangle({{4.0, -5.0, -5.0}, y, z, 10.0, 10.0, -1});
  scene.addRectangle({{0.0, -0.5, -0.5}, y, z, 1.0, 1.0, 0});
  scene.addEdge({{4.0, -5.0, 0.1}, {4.0, 5.0, 0.1}});
  return scene;
}

TEST(SceneGeometry, ComesBackFromItsTextBitForBit) {
  const SceneGeometry scene = wallBehindMovingPanel();
  const SceneGeometry back = SceneGeometry::fromText(scene.toText());
  EXPECT_EQ(scene.toText(), back.toText());
  EXPECT_EQ(scene.arguments(), back.arguments());
  ASSERT_EQ(1U, back.bodies().size());
  EXPECT_EQ(scene.bodies()[0].swing, back.bodies()[0].swing);
  EXPECT_EQ(scene.bodies()[0].origin_ns, back.bodies()[0].origin_ns);
  ASSERT_EQ(2U, back.rectangles().size());
  EXPECT_EQ(scene.rectangles()[1].origin, back.rectangles()[1].origin);
  ASSERT_EQ(1U, back.edges().size());
  EXPECT_EQ(scene.edges()[0].start, back.edges()[0].start);
}

TEST(SceneGeometry, KeepsWhatASurfaceIs) {
  SceneGeometry scene = wallBehindMovingPanel();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  for (int kind = 0; kind < kSurfaceKinds; ++kind) {
    scene.addRectangle({{0.0, 0.0, 0.1 * kind}, x, y, 1.0, 1.0, -1, static_cast<SurfaceKind>(kind)});
  }
  const SceneGeometry back = SceneGeometry::fromText(scene.toText());
  EXPECT_EQ(scene.toText(), back.toText());
  ASSERT_EQ(scene.rectangles().size(), back.rectangles().size());
  for (std::size_t i = 0; i < back.rectangles().size(); ++i) {
    EXPECT_EQ(scene.rectangles()[i].kind, back.rectangles()[i].kind);
  }
  EXPECT_THROW(
      SceneGeometry::fromText("tet_line_tracker_scene 1\nrectangle -1 0 0 0 1 0 0 0 1 0 1 1 stone\nend\n"),
      std::runtime_error);
}

TEST(SceneGeometry, RefusesBrokenTextWithASentence) {
  const std::string text = wallBehindMovingPanel().toText();
  EXPECT_THROW(SceneGeometry::fromText(""), std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText("something else\n" + text), std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText(text.substr(0, text.size() / 2)), std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText(text.substr(0, text.size() - 4)), std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText("tet_line_tracker_scene 1\nsphere 1 2 3\nend\n"), std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText("tet_line_tracker_scene 1\nedge 1 2 x 4 5 6\nend\n"),
               std::runtime_error);
  EXPECT_THROW(SceneGeometry::fromText("tet_line_tracker_scene 1\nrectangle 0 0 0 0 1 0 0 0 1 0 1 1\nend\n"),
               std::runtime_error);
}

TEST(SceneGeometry, HitsTheNearestSurfaceWhereItIsAtThatTime) {
  const SceneGeometry scene = wallBehindMovingPanel();
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  const auto panel = scene.raycast(origin, ahead, 1000000000);
  ASSERT_TRUE(panel);
  EXPECT_EQ(1, panel->point.surface);
  EXPECT_NEAR(2.0, panel->distance, 1e-12);
  EXPECT_NEAR(0.5, panel->point.position.x(), 1e-12);

  // A second later the panel has swung a third of a metre: 0.7 m beside the centre it is hit, before not.
  const Eigen::Vector3d beside = Eigen::Vector3d(2.0, 0.7, 0.0).normalized();
  EXPECT_EQ(0, scene.raycast(origin, beside, 1000000000)->point.surface);
  EXPECT_EQ(1, scene.raycast(origin, beside, 2000000000)->point.surface);
  EXPECT_FALSE(scene.raycast(origin, -ahead, 1000000000));
}

TEST(SceneGeometry, PointAtGivesThePointThatTheRayHit) {
  const SceneGeometry scene = wallBehindMovingPanel();
  const Eigen::Vector3d origin(0.1, -0.2, 0.05);
  for (int i = 0; i < 50; ++i) {
    const std::int64_t stamp_ns = 1000000000 + i * 77000000LL;
    const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.02 * i - 0.5, 0.01 * i - 0.2).normalized();
    const auto hit = scene.raycast(origin, direction, stamp_ns);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(0.0, (scene.pointAt(hit->point, stamp_ns) - (origin + hit->distance * direction)).norm(),
                1e-12);
  }
  EXPECT_THROW(scene.pointAt({7, {0.0, 0.0}}, 0), std::out_of_range);
}

}  // namespace
}  // namespace tet_line_tracker
