#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/so3.h"
#include "scene_images.h"
#include "tet_line_tracker/motion/motion_prior.h"

namespace tet_line_tracker {
namespace {

using Pose = BoardScene::Pose;

constexpr std::int64_t kPeriod = 100000000;  // [ns]
constexpr double kDegree = M_PI / 180.0;

/// base_link in the camera: x forward, y left, z up.
Eigen::Isometry3d cameraFromBody() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0.0, -1.0, 0.0,  //
      0.0, 0.0, -1.0,               //
      1.0, 0.0, 0.0;
  pose.translation() = Eigen::Vector3d(0.1, 0.5, -0.3);
  return pose;
}

Eigen::Isometry3d worldFromCamera(const Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = pose.camera_from_world.transpose();
  result.translation() = pose.position;
  return result;
}

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) / kDegree;
}

class OdometryPriorTest : public testing::Test {
 protected:
  OdometryPriorTest() : prior_(parameters()) {
    prior_.setCamera(BoardScene::camera());
    prior_.setOdometryExtrinsic(cameraFromBody());
  }

  static MotionPriorParameters parameters() {
    MotionPriorParameters parameters;
    parameters.prior = "odometry";
    return parameters;
  }

  /// The next image, 0.1 s later, of a camera at `pose` whose odometry says that it is at `told`, in a frame
  /// of its own.
  MotionPrediction see(const Pose& pose, const Pose& told, bool bare = false) {
    const Eigen::Isometry3d odometry_from_world(
        Eigen::AngleAxisd(1.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
    stamp_ns_ += kPeriod;
    prior_.addOdometry(stamp_ns_, odometry_from_world * worldFromCamera(told) * cameraFromBody());
    ImagePyramid pyramid;
    const cv::Mat image =
        bare ? cv::Mat(BoardScene::kHeight, BoardScene::kWidth, CV_8UC1, cv::Scalar(90)) : scene_.image(pose);
    pyramid.build(image, MotionPrior::kPyramidLevels);
    return prior_.predict(pyramid, stamp_ns_);
  }
  MotionPrediction see(const Pose& pose) { return see(pose, pose); }

  static Pose at(const Eigen::Vector3d& position, const Eigen::Vector3d& degrees = Eigen::Vector3d::Zero()) {
    return {position, so3Exp(kDegree * degrees).toRotationMatrix()};
  }

  BoardScene scene_ = BoardScene::random(5);
  MotionPrior prior_;
  std::int64_t stamp_ns_{1000000000000};
};

TEST_F(OdometryPriorTest, TellsTheRotationAndTheDirectionOfTheTranslation) {
  const Pose start = at({0, 0, 0});
  const Pose next = at({0.15, -0.05, 0.2}, {2.0, -4.0, 3.0});
  EXPECT_STREQ(see(start).sourceName(), "none") << "the first image has none before it";
  const MotionPrediction motion = see(next);
  EXPECT_STREQ(motion.sourceName(), "odometry");
  EXPECT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation.transpose() * next.camera_from_world).norm(), 0.2 * kDegree);
  EXPECT_LT(degreesBetween(motion.translation, -(next.camera_from_world * next.position)), 3.0);
}

TEST_F(OdometryPriorTest, LeadsAcrossATurnFarBeyondTheReachOfTheFlow) {
  // 35 degrees are 315 px; the flow of corners reaches about 110 px.
  see(at({0, 0, 0}));
  const Pose next = at({0.05, 0.0, 0.0}, {4.0, 35.0, 5.0});
  const MotionPrediction motion = see(next);
  EXPECT_STREQ(motion.sourceName(), "odometry");
  EXPECT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation.transpose() * next.camera_from_world).norm(), 0.5 * kDegree);
}

TEST_F(OdometryPriorTest, CornersCorrectAnOdometryThatKnowsNeitherPitchNorRoll) {
  see(at({0, 0, 0}));
  const Pose next = at({0.0, 0.0, 0.3}, {1.0, 0.0, -0.8});
  const MotionPrediction motion = see(next, at({0.0, 0.0, 0.3}));
  ASSERT_TRUE(motion.confirmed);
  EXPECT_LT(so3Log(motion.rotation.transpose() * next.camera_from_world).norm(), 0.3 * kDegree);
  EXPECT_LT(degreesBetween(motion.translation, -(next.camera_from_world * next.position)), 6.0);
}

TEST_F(OdometryPriorTest, CornersOverruleAWrongDirection) {
  see(at({0, 0, 0}));
  const MotionPrediction motion = see(at({0.2, 0.0, 0.0}), at({0.0, 0.0, 0.2}));
  ASSERT_TRUE(motion.translates());
  EXPECT_GT(motion.inliers, 20U);
  EXPECT_LT(degreesBetween(motion.translation, {-1.0, 0.0, 0.0}), 5.0);
}

TEST_F(OdometryPriorTest, ABareWallHasNothingAgainstIt) {
  see(at({0, 0, 0}), at({0, 0, 0}), true);
  const Pose first = at({0.2, 0.0, 0.1}, {0.0, 3.0, 0.0});
  const MotionPrediction motion = see(first, first, true);
  EXPECT_STREQ(motion.sourceName(), "odometry");
  EXPECT_FALSE(motion.confirmed);
  EXPECT_EQ(motion.inliers, 0U);
  EXPECT_LT(so3Log(motion.rotation.transpose() * first.camera_from_world).norm(), 1e-6);
  EXPECT_LT(degreesBetween(motion.translation, -(first.camera_from_world * first.position)), 1e-3);
}

TEST_F(OdometryPriorTest, TellsHowMuchLongerAStepIsWhereCornersCannot) {
  see(at({0, 0, 0}), at({0, 0, 0}), true);
  const MotionPrediction first = see(at({0.1, 0, 0}), at({0.1, 0, 0}), true);
  EXPECT_EQ(first.step_ratio, 0.0);
  EXPECT_NEAR(see(at({0.35, 0, 0}), at({0.35, 0, 0}), true).step_ratio, 2.5, 1e-6);
}

TEST_F(OdometryPriorTest, AWrongTurnCostsAnotherTryAndIsReplacedByWhatCornersShow) {
  const auto pose = [](int k) { return at({0.1 * k, 0.0, 0.0}, {0.0, 1.0 * k, 0.0}); };
  for (int k = 0; k < 3; ++k) see(pose(k));
  // Off by 50 degrees from each image to the next.
  for (int k = 3; k < 5; ++k) {
    const MotionPrediction motion = see(pose(k), at(pose(k).position, {50.0 * (k - 2), 1.0 * k, 0.0}));
    EXPECT_STREQ(motion.sourceName(), "image");
    EXPECT_TRUE(motion.confirmed);
    const Eigen::Matrix3d turn = pose(k).camera_from_world * pose(k - 1).camera_from_world.transpose();
    EXPECT_LT(so3Log(motion.rotation.transpose() * turn).norm(), 1.0 * kDegree);
  }
  // Wrong by a fixed turn of its frame, but right from image to image.
  MotionPrediction last;
  for (int k = 5; k < 8; ++k) last = see(pose(k), at(pose(k).position, {150.0, 1.0 * k, 0.0}));
  EXPECT_STREQ(last.sourceName(), "odometry");
  EXPECT_TRUE(last.confirmed);
}

TEST_F(OdometryPriorTest, SaysNothingOfTheFirstImageAfterAReset) {
  see(at({0, 0, 0}), at({0, 0, 0}), true);
  prior_.reset();
  EXPECT_STREQ(see(at({0.2, 0, 0}), at({0.2, 0, 0}), true).sourceName(), "none");
}

TEST_F(OdometryPriorTest, AStandingCameraHasNoDirectionOfTranslation) {
  see(at({0, 0, 0}), at({0, 0, 0}), true);
  const MotionPrediction motion = see(at({0.001, 0, 0}), at({0.001, 0, 0}), true);
  EXPECT_STREQ(motion.sourceName(), "odometry");
  EXPECT_FALSE(motion.translates());
}

TEST_F(OdometryPriorTest, WithoutItsPoseOrItsMessagesTheImagesStandIn) {
  MotionPrior without_pose(parameters());
  without_pose.setCamera(BoardScene::camera());
  MotionPrior without_messages(parameters());
  without_messages.setCamera(BoardScene::camera());
  without_messages.setOdometryExtrinsic(cameraFromBody());
  for (int k = 0; k < 2; ++k) {
    const Pose pose = at({0.0, 0.0, 0.0}, {0.0, 2.0 * k, 0.0});
    ImagePyramid pyramid;
    pyramid.build(scene_.image(pose), MotionPrior::kPyramidLevels);
    without_pose.addOdometry(k * kPeriod, worldFromCamera(pose));
    for (MotionPrior* prior : {&without_pose, &without_messages}) {
      const MotionPrediction motion = prior->predict(pyramid, k * kPeriod);
      EXPECT_STREQ(motion.sourceName(), k == 0 ? "none" : "image");
    }
  }
}

}  // namespace
}  // namespace tet_line_tracker
