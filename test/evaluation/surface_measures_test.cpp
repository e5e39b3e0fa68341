#include "evaluation/surface_measures.h"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/scene_truth.h"

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kFirstStamp = 1000000000;
constexpr std::int64_t kPeriod = 50000000;

/// A wall at z = 6 with a mirror and a screen just before it, and a column of two facets at z = 3, seen from
/// the origin with 100 px focal length.
class Scene {
 public:
  Scene() {
    CameraCalibration calibration;
    calibration.model = "plumb_bob";
    calibration.width = 400;
    calibration.height = 300;
    calibration.fx = calibration.fy = 100.0;
    calibration.cx = 200.0;
    calibration.cy = 150.0;
    camera = makeCameraModel(calibration);
    add(-20.0, -20.0, 6.0, 40.0, 40.0, SurfaceKind::kSolid);
    add(-3.0, -3.0, 5.0, 2.5, 6.0, SurfaceKind::kMirror);
    add(2.0, -3.0, 5.0, 2.5, 6.0, SurfaceKind::kScreen);
    add(0.0, -3.0, 3.0, 0.3, 6.0, SurfaceKind::kRound);
    add(0.3, -3.0, 3.0, 0.3, 6.0, SurfaceKind::kRound);
    for (int image = 0; image < 3; ++image) {
      poses.add(kFirstStamp + image * kPeriod, Eigen::Isometry3d::Identity());
    }
    poses.sort();
  }

  SceneTruth truth() const { return SceneTruth(geometry, poses, camera); }

  /// An upright line through x on the plane at z.
  static TrackedLine upright(std::uint64_t id, double x, double z) {
    const auto column = static_cast<float>(200.0 + 100.0 * x / z);
    TrackedLine line;
    line.id = id;
    line.segment = {{column, 110.0F}, {column, 190.0F}};
    return line;
  }

  SceneGeometry geometry;
  PoseTrack poses;
  std::shared_ptr<const CameraModel> camera;

 private:
  void add(double x, double y, double z, double width, double height, SurfaceKind kind) {
    geometry.addRectangle(
        {{x, y, z}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), width, height, -1, kind});
  }
};

SurfaceKind kindOf(double x, double z) {
  const Scene scene;
  LineFrame frame;
  frame.stamp_ns = kFirstStamp;
  frame.lines = {Scene::upright(1, x, z)};
  for (const SurfaceMeasures& m : measureSurfaces({frame}, scene.truth(), {}, 2.0)) {
    if (m.tracks == 1) return m.kind;
  }
  ADD_FAILURE() << "the line is on no surface";
  return SurfaceKind::kSolid;
}

TEST(SurfaceMeasures, KnowsWhatALineIsOn) {
  EXPECT_EQ(SurfaceKind::kSolid, kindOf(-5.0, 6.0)) << "painted on the wall";
  EXPECT_EQ(SurfaceKind::kMirror, kindOf(-1.5, 5.0));
  EXPECT_EQ(SurfaceKind::kSolid, kindOf(-3.0, 5.0)) << "the rim of a mirror is a straight edge";
  EXPECT_EQ(SurfaceKind::kScreen, kindOf(3.0, 5.0));
  EXPECT_EQ(SurfaceKind::kSolid, kindOf(2.0, 5.0)) << "so is that of a screen";
  EXPECT_EQ(SurfaceKind::kRound, kindOf(0.0, 3.0)) << "the outline of a column, on the left";
  EXPECT_EQ(SurfaceKind::kRound, kindOf(0.6, 3.0)) << "and on the right";
  EXPECT_EQ(SurfaceKind::kSolid, kindOf(0.3, 3.0)) << "painted on the column";
}

TEST(SurfaceMeasures, CountsTracksAndTheirImages) {
  const Scene scene;
  std::vector<LineFrame> frames(3);
  for (int image = 0; image < 3; ++image) {
    LineFrame& frame = frames[static_cast<std::size_t>(image)];
    frame.stamp_ns = kFirstStamp + image * kPeriod;
    frame.lines.push_back(Scene::upright(1, -5.0, 6.0));
    // Leaves the screen for the wall in its last image.
    frame.lines.push_back(image < 2 ? Scene::upright(2, 3.0, 5.0) : Scene::upright(2, 6.0, 6.0));
    if (image > 0) frame.lines.push_back(Scene::upright(3, 4.0, 5.0));
  }
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto pair = [](std::size_t frame, std::uint64_t id, double error) {
    PairError result;
    result.frame = frame;
    result.id = id;
    result.error = error;
    return result;
  };
  const auto measures = measureSurfaces(
      frames, scene.truth(),
      {pair(0, 1, 0.1), pair(1, 1, 0.2), pair(0, 2, 1.9), pair(1, 2, 2.1), pair(1, 3, kNaN)}, 2.0);
  ASSERT_EQ(static_cast<std::size_t>(kSurfaceKinds), measures.size());
  const SurfaceMeasures& solid = measures[static_cast<std::size_t>(SurfaceKind::kSolid)];
  EXPECT_EQ(1U, solid.tracks);
  EXPECT_DOUBLE_EQ(3.0, solid.track_length);
  EXPECT_DOUBLE_EQ(3.0 / 8.0, solid.line_share);
  EXPECT_DOUBLE_EQ(1.0, solid.inlier_ratio);
  const SurfaceMeasures& screen = measures[static_cast<std::size_t>(SurfaceKind::kScreen)];
  EXPECT_EQ(2U, screen.tracks);
  EXPECT_DOUBLE_EQ(2.5, screen.track_length);
  EXPECT_DOUBLE_EQ(5.0 / 8.0, screen.line_share);
  EXPECT_DOUBLE_EQ(0.5, screen.inlier_ratio);
  const SurfaceMeasures& mirror = measures[static_cast<std::size_t>(SurfaceKind::kMirror)];
  EXPECT_EQ(0U, mirror.tracks);
  EXPECT_TRUE(std::isnan(mirror.track_length));
}

}  // namespace
}  // namespace tet_line_tracker
