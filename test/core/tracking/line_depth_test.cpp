#include "tracking/line_depth.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

/// A line between two points [m] before a camera that then steps so that points move by `step` [m].
struct Scene {
  Eigen::Vector3d start{-0.5, -0.4, 2.0};
  Eigen::Vector3d end{0.6, 0.5, 4.0};
  Eigen::Vector3d step{0.1, 0.02, -0.2};

  LineStep seen() const {
    LineStep line;
    line.start_before = start / start.z();
    line.end_before = end / end.z();
    line.start_now = (start + step).hnormalized();
    line.end_now = (end + step).hnormalized();
    return line;
  }
  Eigen::Vector3d direction() const { return step.normalized(); }
  /// In units of 1 / the step.
  Eigen::Vector2d inverse() const { return step.norm() * Eigen::Vector2d(1.0 / start.z(), 1.0 / end.z()); }
  Eigen::Vector2d inverseNow() const {
    return step.norm() * Eigen::Vector2d(1.0 / (start + step).z(), 1.0 / (end + step).z());
  }
};

TEST(LineDepth, IsMeasuredFromTheMovementAcrossTheLine) {
  const Scene scene;
  const LineDepth depth = measureDepth(scene.seen(), scene.direction(), 0.001);
  ASSERT_TRUE(depth.known);
  EXPECT_LT((depth.inverse - scene.inverse()).norm(), 1e-9);
}

TEST(LineDepth, IsMeasuredAlikeWhenTheEndsSlideAlongTheLine) {
  const Scene scene;
  LineStep line = scene.seen();
  const Eigen::Vector2d along = line.end_now - line.start_now;
  line.start_now += 0.2 * along;
  line.end_now += 0.1 * along;
  EXPECT_LT((measureDepth(line, scene.direction(), 0.001).inverse - scene.inverse()).norm(), 1e-9);
}

TEST(LineDepth, IsNotKnownOfALineThatMovesAlongItself) {
  Scene scene;
  scene.step = 0.1 * (scene.end - scene.start);
  EXPECT_FALSE(measureDepth(scene.seen(), scene.direction(), 0.001).known);
}

TEST(LineDepth, MovesWithTheCameraAndWithTheEnds) {
  const Scene scene;
  LineStep line = scene.seen();
  LineDepth depth;
  depth.known = true;
  depth.inverse = scene.inverse();
  depth.variance.setConstant(1e-6);
  EXPECT_LT((movedTo(line, depth, scene.direction()).inverse - scene.inverseNow()).norm(), 1e-9);
  // A quarter of the line is lost at its start: inverse depth is linear between the ends in the image.
  line.start_now += 0.25 * (line.end_now - line.start_now);
  const Eigen::Vector2d now = scene.inverseNow();
  EXPECT_NEAR(movedTo(line, depth, scene.direction()).inverse[0], 0.75 * now[0] + 0.25 * now[1], 1e-9);
}

TEST(LineDepth, IsInTheUnitOfTheNextStep) {
  LineDepth depth;
  depth.known = true;
  depth.inverse = {0.1, 0.2};
  depth.variance = {1e-4, 1e-4};
  const LineDepth twice = depth.inUnitOf(2.0);
  EXPECT_LT((twice.inverse - Eigen::Vector2d(0.2, 0.4)).norm(), 1e-12);
  EXPECT_GT(twice.variance[0], 4e-4) << "and is less sure";
}

TEST(LineDepth, TheSurerOfTwoEstimatesCountsMore) {
  LineDepth expected;
  expected.known = true;
  expected.inverse = {0.1, 0.1};
  expected.variance = {1e-4, 1e-4};
  LineDepth measured = expected;
  measured.inverse = {0.2, 0.2};
  measured.variance = {3e-4, 1e-6};
  const LineDepth both = fused(expected, measured);
  EXPECT_NEAR(both.inverse[0], 0.125, 1e-9);
  EXPECT_GT(both.inverse[1], 0.198);
}

TEST(LineDepth, TheSensitivityIsTheMovementAcrossTheLine) {
  const Scene scene;
  const Eigen::Vector2d inverse = scene.inverse();
  const double change = 1e-4;
  const LineStep line = scene.seen();
  const Eigen::Vector2d before = (line.start_before + inverse[0] * scene.direction()).hnormalized();
  const Eigen::Vector2d after = (line.start_before + (inverse[0] + change) * scene.direction()).hnormalized();
  const Eigen::Vector2d d = (line.end_now - line.start_now).normalized();
  const double across = Eigen::Vector2d(d.y(), -d.x()).dot(after - before) / change;
  EXPECT_NEAR(sensitivityOf(line, inverse, scene.direction()).across[0], across, 1e-4);
}

TEST(LineDepth, BehindTheCameraIsAContradiction) {
  Scene scene;
  const LineDepth measured = measureDepth(scene.seen(), -scene.direction(), 0.0005);
  EXPECT_TRUE(contradicts(measured, LineDepth{}, false, 0.005));
  EXPECT_FALSE(contradicts(measureDepth(scene.seen(), scene.direction(), 0.0005), LineDepth{}, false, 0.005));
}

TEST(LineDepth, AJumpIsAContradictionOnlyWhereTheDepthWasKnown) {
  const Scene scene;
  const LineDepth measured = measureDepth(scene.seen(), scene.direction(), 0.0005);
  LineDepth expected = measured;
  expected.inverse *= 4.0;
  EXPECT_TRUE(contradicts(measured, expected, true, 0.005));
  EXPECT_FALSE(contradicts(measured, expected, false, 0.005));
  EXPECT_FALSE(contradicts(measured, measured, true, 0.005));
}

}  // namespace
}  // namespace tet_line_tracker
