#include "evaluation/three_view_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/baselines/lk_endpoints.h"
#include "evaluation/scene_truth.h"
#include "evaluation/track_measures.h"
#include "simulation/simulation.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

std::int64_t stampOf(int image) {
  return 1000000000 + static_cast<std::int64_t>(image) * 50000000;
}

CameraCalibration pinhole() {
  CameraCalibration calibration;
  calibration.width = 640;
  calibration.height = 480;
  calibration.fx = calibration.fy = 400.0;
  calibration.cx = 319.5;
  calibration.cy = 239.5;
  calibration.model = "plumb_bob";
  return calibration;
}

Eigen::Isometry3d poseAt(const Eigen::Vector3d& position, double yaw = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return pose;
}

/// A line of space seen by a camera, its ends displaced in the image [px].
TrackedLine lineOf(const CameraModel& camera, const Eigen::Isometry3d& pose, const Eigen::Vector3d& start,
                   const Eigen::Vector3d& end, const Eigen::Vector2d& displacement = {0.0, 0.0}) {
  TrackedLine line;
  const auto see = [&](const Eigen::Vector3d& point, Eigen::Vector2f& pixel, Eigen::Vector2d& normalized) {
    const Eigen::Vector2d at = *camera.project(pose.inverse() * point) + displacement;
    pixel = at.cast<float>();
    normalized = *camera.normalize(at);
  };
  see(start, line.segment.start, line.start_normalized);
  see(end, line.segment.end, line.end_normalized);
  return line;
}

const Eigen::Vector3d kStart(-0.4, -0.9, 5.0);
const Eigen::Vector3d kEnd(-0.1, 0.8, 6.0);  // about upright

/// Three views in steady motion to the side.
class Views {
 public:
  explicit Views(const CameraCalibration& calibration = pinhole())
      : Views({poseAt({0.0, 0.0, 0.0}), poseAt({0.3, 0.05, 0.1}, 0.03), poseAt({0.6, 0.1, 0.2}, 0.05)},
              calibration) {}
  explicit Views(const std::array<Eigen::Isometry3d, 3>& poses,
                 const CameraCalibration& calibration = pinhole())
      : camera_(makeCameraModel(calibration)), poses_(poses) {}

  /// `displaced`: of which view the line is not where the truth has it, to the right [px].
  std::optional<ThreeViewError> error(int displaced = -1, double px = 0.0,
                                      const Eigen::Vector3d& start = kStart,
                                      const Eigen::Vector3d& end = kEnd) const {
    std::array<TrackedLine, 3> lines;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool here = static_cast<int>(i) == displaced;
      lines[i] = lineOf(*camera_, poses_[i], start, end, {here ? px : 0.0, 0.0});
    }
    return threeViewError(*camera_, poses_, {&lines[0], &lines[1], &lines[2]});
  }

 private:
  std::shared_ptr<const CameraModel> camera_;
  std::array<Eigen::Isometry3d, 3> poses_;
};

TEST(ThreeViewError, IsZeroForThreeTrueViewsAlsoThroughALens) {
  for (const CameraCalibration& calibration : {pinhole(), defaultSimulatedCamera()}) {
    const auto error = Views(calibration).error();
    ASSERT_TRUE(error);
    EXPECT_LT(error->error_px, 1e-3);
    EXPECT_NEAR(error->sensitivity, 0.5, 0.2);
    EXPECT_FALSE(error->isIllPosed());
  }
}

TEST(ThreeViewError, IsTheDistanceOfTheMiddleLine) {
  const auto error = Views().error(1, 3.0);
  ASSERT_TRUE(error);
  // Three pixels to the right are a little less across a line that leans.
  EXPECT_GT(error->error_px, 2.8);
  EXPECT_LE(error->error_px, 3.0 + 1e-6);
}

TEST(ThreeViewError, SeesHalfOfTheErrorOfAnOuterViewInSteadyMotion) {
  for (const int view : {0, 2}) {
    const auto error = Views().error(view, 4.0);
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->error_px, 2.0, 0.5) << view;
  }
}

TEST(ThreeViewError, LeavesOutALineWhoseDepthOnlyTheMiddleViewSees) {
  // The outer cameras move in one plane with the line.
  const Views lowered({poseAt({0.0, 0.0, 0.0}), poseAt({0.3, 0.05, 0.0}), poseAt({0.6, 0.0, 0.0})});
  const auto error = lowered.error(-1, 0.0, {-1.0, 0.3, 4.0}, {1.0, 0.3, 4.0});
  EXPECT_TRUE(!error || error->isIllPosed());
  // An upright line is well seen by the same cameras.
  ASSERT_TRUE(lowered.error());
  EXPECT_FALSE(lowered.error()->isIllPosed());
}

TEST(ThreeViewError, LeavesOutWhatTheMiddleViewWouldHaveToExtrapolateFar) {
  const Views far_middle({poseAt({0.0, 0.0, 0.0}), poseAt({0.6, 0.0, 0.0}), poseAt({0.06, 0.0, 0.0})});
  const auto error = far_middle.error();
  ASSERT_TRUE(error);
  EXPECT_GT(error->sensitivity, 5.0);
  EXPECT_TRUE(error->isIllPosed());
}

TEST(ThreeViewError, DividesTheErrorByASensitivityOverOne) {
  // The middle view lies three baselines away: a pixel in the last one moves the projection by three.
  const Views beyond({poseAt({0.0, 0.0, 0.0}), poseAt({0.6, 0.0, 0.0}), poseAt({0.2, 0.0, 0.0})});
  const auto error = beyond.error(1, 3.0);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->sensitivity, 3.0, 0.4);
  EXPECT_NEAR(error->error_px, 1.0, 0.15);
}

/// One track of five images, which jumps by `jump_px` to the side at the fourth and stays there.
std::vector<LineFrame> trackWithJump(const CameraModel& camera, const PoseTrack& poses, double jump_px) {
  std::vector<LineFrame> frames(5);
  for (int k = 0; k < 5; ++k) {
    LineFrame& frame = frames[static_cast<std::size_t>(k)];
    frame.stamp_ns = stampOf(k);
    frame.width = 640;
    frame.height = 480;
    TrackedLine line = lineOf(camera, poses.at(stampOf(k)).value_or(Eigen::Isometry3d::Identity()), kStart,
                              kEnd, {k >= 3 ? jump_px : 0.0, 0.0});
    line.id = 7;
    frame.lines.push_back(line);
  }
  return frames;
}

TEST(ThreeViewMeasures, CountTheTriplesThatAJumpRefutes) {
  const auto camera = makeCameraModel(pinhole());
  PoseTrack poses;
  for (int k = 0; k < 5; ++k) poses.add(stampOf(k), poseAt({0.1 * k, 0.02 * k, 0.0}));
  poses.sort();
  const ThreeViewMeasures clean = measureThreeViews(trackWithJump(*camera, poses, 0.0), poses, *camera);
  EXPECT_EQ(clean.triples, 3U);
  EXPECT_EQ(clean.left_out, 0U);
  EXPECT_EQ(clean.refuted, 0U);
  EXPECT_DOUBLE_EQ(clean.tight_inlier_ratio, 1.0);
  // Images 1 2 3 and 2 3 4 hold the jump, half of which each triple sees.
  const ThreeViewMeasures small = measureThreeViews(trackWithJump(*camera, poses, 3.0), poses, *camera);
  EXPECT_EQ(small.refuted, 0U);
  EXPECT_DOUBLE_EQ(small.tight_inlier_ratio, 1.0 / 3.0);
  const ThreeViewMeasures large = measureThreeViews(trackWithJump(*camera, poses, 9.0), poses, *camera);
  EXPECT_EQ(large.refuted, 2U);
  EXPECT_DOUBLE_EQ(large.inlier_ratio, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(large.refuted_ratio, 2.0 / 3.0);
}

TEST(ThreeViewMeasures, LeaveOutOfTheCountWhatHasNoPose) {
  const auto camera = makeCameraModel(pinhole());
  PoseTrack poses;
  for (int k = 1; k < 5; ++k) poses.add(stampOf(k), poseAt({0.1 * k, 0.02 * k, 0.0}));
  poses.sort();
  EXPECT_EQ(measureThreeViews(trackWithJump(*camera, poses, 0.0), poses, *camera).triples, 2U);
}

/// Of the tracker without a prior and of LK endpoints, which both go astray, on a fast flight.
std::array<TripleAgreement, 2> judgeFlight(std::uint64_t seed) {
  SimulationOptions options;
  options.motion = "fast";
  options.seconds = 2.0;
  options.seed = seed;
  options.threads = 2;
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  Simulation simulation(options, camera);
  LineTrackerParameters without_prior;
  without_prior.motion.prior = "none";
  without_prior.plausibility.max_edge_offset = 10.0;
  LineTracker tracker(without_prior);
  LkEndpoints endpoints(LineTrackerParameters{}, makeLineDetector("lsd"));
  const std::array<LineFrontEnd*, 2> front_ends{&tracker, &endpoints};
  for (LineFrontEnd* front_end : front_ends) front_end->setCamera(camera);
  PoseTrack poses;
  std::array<std::vector<LineFrame>, 2> frames;
  for (int i = 0; i < simulation.imageCount(); ++i) {
    const std::int64_t stamp = simulation.imageStamp(i);
    poses.add(stamp, simulation.trajectory().worldFromCamera(simulation.timeOf(stamp)));
    const cv::Mat image = simulation.nextImage();
    for (std::size_t k = 0; k < 2; ++k) frames[k].push_back(*front_ends[k]->process(image, stamp).frame);
  }
  poses.sort();
  const SceneTruth truth(simulation.geometry(), poses, camera);
  std::array<TripleAgreement, 2> agreements;
  for (std::size_t k = 0; k < 2; ++k) {
    const ThreeViewMeasures measures = measureThreeViews(frames[k], poses, *camera);
    EXPECT_GT(measures.judged.size(), 500U);
    EXPECT_LT(measures.left_out_ratio, 0.05);
    agreements[k] = compareJudges(measures, measureTracks(frames[k], false, &truth).pairs);
  }
  return agreements;
}

TEST(ThreeViewMeasures, GiveTheShareOfTheExactJudgeWithinHalfAPointOnSimulatedFlights) {
  try {
    makeLineDetector("lsd");
  } catch (const std::invalid_argument& error) {
    GTEST_SKIP() << error.what();
  }
  const std::array<std::uint64_t, 3> seeds{3, 4, 5};
  std::array<double, 2> three_views{};
  std::array<double, 2> exact{};
  for (const std::uint64_t seed : seeds) {
    const std::array<TripleAgreement, 2> agreements = judgeFlight(seed);
    for (std::size_t k = 0; k < 2; ++k) {
      three_views[k] += agreements[k].three_view_ratio / static_cast<double>(seeds.size());
      exact[k] += agreements[k].exact_ratio / static_cast<double>(seeds.size());
    }
  }
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(three_views[k], exact[k], 0.005);
  EXPECT_LT(std::min(exact[0], exact[1]), 0.98) << "where all is right both judges agree for nothing";
}

}  // namespace
}  // namespace tet_line_tracker
