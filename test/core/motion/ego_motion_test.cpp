#include "motion/ego_motion.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/so3.h"
#include "scene_images.h"

namespace tet_line_tracker {
namespace {

using Pose = BoardScene::Pose;

constexpr double kDegree = M_PI / 180.0;

ImagePyramid view(const BoardScene& scene, const Pose& pose) {
  ImagePyramid pyramid;
  pyramid.build(scene.image(pose), MotionPrior::kPyramidLevels);
  return pyramid;
}

Pose at(const Eigen::Vector3d& position, const Eigen::Vector3d& degrees = Eigen::Vector3d::Zero()) {
  return {position, so3Exp(kDegree * degrees).toRotationMatrix()};
}

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) / kDegree;
}

class EgoMotionTest : public testing::Test {
 protected:
  void SetUp() override { tracker_.setCamera(BoardScene::camera()); }

  /// The next image, 0.1 s later; the camera is expected not to turn.
  MotionPrediction see(const Pose& pose,
                       const std::optional<EgoMotionTracker::MeasuredRotation>& gyro = std::nullopt) {
    MotionPrediction prediction;
    tracker_.update(view(scene_, pose), 0.1, gyro, std::nullopt, prediction);
    return prediction;
  }

  BoardScene scene_ = BoardScene::random(5);
  EgoMotionTracker tracker_;
};

TEST_F(EgoMotionTest, TellsHowPointsMoveWhicheverWayTheCameraGoes) {
  for (const Eigen::Vector3d& step : {Eigen::Vector3d(0.15, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 0.3),
                                      Eigen::Vector3d(0.0, 0.0, -0.3), Eigen::Vector3d(-0.1, 0.05, 0.15)}) {
    tracker_.reset();
    see(at({0, 0, 0}));
    const MotionPrediction motion = see(at(step));
    ASSERT_TRUE(motion.translates()) << step.transpose();
    EXPECT_LT(degreesBetween(motion.translation, -step), 4.0) << step.transpose();
    EXPECT_GT(motion.inliers, 20U) << step.transpose();
    EXPECT_LT(so3Log(motion.rotation).norm(), 0.3 * kDegree) << step.transpose();
  }
}

TEST_F(EgoMotionTest, FindsATurnThatNobodyMeasuredBesideTheTranslation) {
  see(at({0, 0, 0}));
  const Pose next = at({0.1, 0.0, 0.1}, {0.5, -1.0, 1.0});
  const MotionPrediction motion = see(next);
  ASSERT_TRUE(motion.translates());
  EXPECT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation.transpose() * next.camera_from_world).norm(), 0.3 * kDegree);
  EXPECT_LT(degreesBetween(motion.translation, -(next.camera_from_world * next.position)), 8.0);
}

TEST_F(EgoMotionTest, OverrulesAGyroscopeThatIsNotTrustedYet) {
  see(at({0, 0, 0}));
  const Pose next = at({0.15, 0.0, 0.05});
  const EgoMotionTracker::MeasuredRotation wrong{
      so3Exp(kDegree * Eigen::Vector3d(3.0, 2.0, 0.0)).toRotationMatrix(), 0.001, false};
  const MotionPrediction motion = see(next, wrong);
  ASSERT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation).norm(), 0.4 * kDegree);
}

TEST_F(EgoMotionTest, FindsATurnFartherThanTheFlowReachesWithAndWithoutAGyroscope) {
  // 25 degrees are 210 px; the flow of corners reaches about 110 px.
  const Pose next = at({0.1, 0.0, 0.0}, {0.0, 25.0, 0.0});
  see(at({0, 0, 0}));
  const MotionPrediction by_corners = see(next);
  EXPECT_TRUE(by_corners.confirmed);
  EXPECT_STREQ(by_corners.sourceName(), "image");
  EXPECT_LT(so3Log(by_corners.rotation.transpose() * next.camera_from_world).norm(), 2.0 * kDegree);

  tracker_.reset();
  see(at({0, 0, 0}));
  const EgoMotionTracker::MeasuredRotation gyro{
      so3Exp(kDegree * Eigen::Vector3d(0.5, 24.0, 0.0)).toRotationMatrix(), 0.01, false};
  const MotionPrediction by_gyro = see(next, gyro);
  EXPECT_TRUE(by_gyro.confirmed);
  EXPECT_STREQ(by_gyro.sourceName(), "imu");
  EXPECT_LT(so3Log(by_gyro.rotation.transpose() * next.camera_from_world).norm(), 0.5 * kDegree);
}

TEST_F(EgoMotionTest, TellsHowMuchLongerAStepIsThanTheLast) {
  see(at({0, 0, 0}));
  EXPECT_EQ(see(at({0.1, 0.0, 0.05})).step_ratio, 0.0) << "there was no last step";
  EXPECT_NEAR(see(at({0.3, 0.0, 0.15})).step_ratio, 2.0, 0.15);
  EXPECT_NEAR(see(at({0.4, 0.0, 0.2})).step_ratio, 0.5, 0.06);
}

TEST_F(EgoMotionTest, KnowsHowDeepItIsNearAPixel) {
  // The left half 2.5 m away, the right half 7.5 m.
  scene_ = BoardScene();
  const BoardScene random = BoardScene::random(6, 200);
  for (Board board : random.boards()) {
    const double z = board.centre.x() < 0.0 ? 2.5 : 7.5;
    const double scale = z / board.centre.z();
    board.centre *= scale;
    board.half_size *= scale;
    scene_.add(board);
  }
  see(at({0, 0, 0}));
  const double step = 0.15;
  ASSERT_TRUE(see(at({step, 0.0, 0.0})).translates());
  const auto near = tracker_.depthNear({120.0F, 240.0F});
  const auto far = tracker_.depthNear({520.0F, 240.0F});
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(near->inverse, step / 2.5, 0.15 * step / 2.5);
  EXPECT_NEAR(far->inverse, step / 7.5, 0.25 * step / 7.5);
}

TEST_F(EgoMotionTest, ACameraThatOnlyTurnsHasNoDirection) {
  see(at({0, 0, 0}));
  const Pose next = at({0, 0, 0}, {0.5, 1.0, -0.5});
  const MotionPrediction motion = see(next);
  EXPECT_FALSE(motion.translates());
  EXPECT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation.transpose() * next.camera_from_world).norm(), 0.1 * kDegree);
  EXPECT_FALSE(tracker_.depthNear({320.0F, 240.0F}));
}

TEST_F(EgoMotionTest, ConfirmsNothingWhereThePictureIsAnother) {
  see(at({0, 0, 0}));
  scene_ = BoardScene::random(77);
  EXPECT_FALSE(see(at({0, 0, 0})).translates());
}

TEST_F(EgoMotionTest, LeavesThePredictionAsItIsWithoutACamera) {
  tracker_.setCamera(nullptr);
  see(at({0, 0, 0}));
  const MotionPrediction motion = see(at({0.2, 0, 0}));
  EXPECT_FALSE(motion.translates());
  EXPECT_EQ(motion.rotation, Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace tet_line_tracker
