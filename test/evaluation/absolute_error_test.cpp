#include "evaluation/absolute_error.h"

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/track_judge.h"

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kStamp = 1000000000;

CameraCalibration calibrationOf(const std::string& lens) {
  CameraCalibration calibration;
  calibration.width = 752;
  calibration.height = 480;
  calibration.fx = 458.654;
  calibration.fy = 457.296;
  calibration.cx = 367.215;
  calibration.cy = 248.375;
  calibration.model = "plumb_bob";
  if (lens == "euroc") calibration.distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  if (lens == "equidistant") {
    calibration.model = "equidistant";
    calibration.fx = calibration.fy = 230.0;
    calibration.distortion = {0.0, 0.0, 0.0, 0.0};
  }
  if (lens == "mei") {
    calibration.model = "mei";
    calibration.fx = calibration.fy = 668.2;
    calibration.distortion = {2.2134, 0.0168, 1.6549, 0.0, 0.0};
  }
  return calibration;
}

/// A wall 4 m ahead of a camera that looks along z, with edges on it, and a panel before it.
class EdgeScene {
 public:
  explicit EdgeScene(const std::string& lens) : camera(makeCameraModel(calibrationOf(lens))) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    scene.addRectangle({{-10, -10, 4}, x, y, 20, 20, -1});
    scene.addRectangle({{2, -1.5, 2}, x, y, 3, 3, -1});
    scene.addEdge({{-2.5, -1.2, 4}, {1.5, -1.0, 4}});  // 0: alone, long
    scene.addEdge({{-2.0, -0.5, 4}, {-2.0, 1.5, 4}});  // 1: alone
    scene.addEdge({{-1.0, 0.4, 4}, {1.0, 0.4, 4}});    // 2 and 3: a joint of 1.8 px
    scene.addEdge({{-1.0, 0.416, 4}, {1.0, 0.416, 4}});
    scene.addEdge({{-1.0, 1.2, 4}, {0.2, 1.2, 4}});  // 4 and 5: two pieces of one
    scene.addEdge({{0.2, 1.2, 4}, {1.0, 1.2, 4}});
    scene.addEdge({{4.2, -2, 4}, {4.2, 2, 4}});        // 6: behind the panel
    scene.addEdge({{-1.0, -1.6, 4}, {1.0, -1.6, 4}});  // 7 and 8: 4.6 px apart
    scene.addEdge({{-1.0, -1.64, 4}, {1.0, -1.64, 4}});
    poses.add(kStamp, Eigen::Isometry3d::Identity());
    poses.add(kStamp + 50000000, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.02, 0.03)));
    poses.sort();
    truth = std::make_unique<SceneTruth>(scene, poses, camera);
  }

  /// Part of an edge as a line whose undistorted ends are off by so much, on z = 1 [px].
  TrackedLine line(std::size_t edge, double from, double to, double start_px, double end_px) const {
    const TrueEdge& e = scene.edges()[edge];
    const double focal = std::sqrt(camera->calibration().fx * camera->calibration().fy);
    const Eigen::Vector2d start = (e.start + from * (e.end - e.start)).hnormalized();
    const Eigen::Vector2d end = (e.start + to * (e.end - e.start)).hnormalized();
    const Eigen::Vector2d along = (end - start).normalized();
    const Eigen::Vector2d left(along.y(), -along.x());
    TrackedLine line;
    line.start_normalized = start + start_px / focal * left;
    line.end_normalized = end + end_px / focal * left;
    line.segment = {camera->project(line.start_normalized.homogeneous())->cast<float>(),
                    camera->project(line.end_normalized.homogeneous())->cast<float>()};
    return line;
  }

  EdgeVerdict judge(const TrackedLine& line) const {
    LineFrame frame;
    frame.stamp_ns = kStamp;
    frame.lines.push_back(line);
    return EdgeJudge(*truth).judge(frame).front();
  }

  std::shared_ptr<const CameraModel> camera;
  SceneGeometry scene;
  PoseTrack poses;
  std::unique_ptr<SceneTruth> truth;
};

class EdgeJudgeTest : public testing::TestWithParam<const char*> {};

TEST_P(EdgeJudgeTest, GivesBackTheOffsetsOfTheUndistortedEnds) {
  const EdgeScene world(GetParam());
  for (const auto& [from, to] : {std::make_pair(0.05, 0.95), std::make_pair(0.4, 0.52)}) {
    for (const double start_px : {-2.0, -0.5, 0.0, 0.1, 0.3, 1.0, 2.0}) {
      for (const double end_px : {-2.0, -0.1, 0.0, 0.2, 2.0, 4.5}) {
        for (const std::size_t edge : {0U, 1U}) {
          const EdgeVerdict verdict = world.judge(world.line(edge, from, to, start_px, end_px));
          ASSERT_EQ(verdict.kind, EdgeVerdict::Kind::kJudged) << edge << " " << start_px << " " << end_px;
          EXPECT_EQ(verdict.edge, edge);
          EXPECT_NEAR(std::abs(verdict.start_px), std::abs(start_px), 1e-6);
          EXPECT_NEAR(std::abs(verdict.end_px), std::abs(end_px), 1e-6);
          EXPECT_NEAR(std::abs(verdict.middle_px), 0.5 * std::abs(start_px + end_px), 1e-6);
        }
      }
    }
  }
}

TEST_P(EdgeJudgeTest, LeavesOutLinesOfWhichTwoEdgesMayBeMeantHoweverNearTheyAreToOne) {
  const EdgeScene world(GetParam());
  for (const double px : {0.0, 0.3, 0.9, 2.5}) {
    for (const std::size_t edge : {2U, 3U}) {
      EXPECT_EQ(world.judge(world.line(edge, 0.2, 0.7, px, px)).kind, EdgeVerdict::Kind::kAmbiguous);
    }
  }
}

TEST_P(EdgeJudgeTest, DoesNotGiveLinesToANeighbourThatIsFarEnoughNotToCompete) {
  const EdgeScene world(GetParam());
  for (const double px : {-2.0, -1.5, 1.5, 2.0}) {
    for (const std::size_t edge : {7U, 8U}) {
      const EdgeVerdict verdict = world.judge(world.line(edge, 0.2, 0.7, px, px));
      ASSERT_EQ(verdict.kind, EdgeVerdict::Kind::kJudged) << px;
      EXPECT_EQ(verdict.edge, edge);
      EXPECT_NEAR(std::abs(verdict.middle_px), std::abs(px), 1e-6);
    }
  }
}

TEST_P(EdgeJudgeTest, TakesPiecesOfOneStraightEdgeForOne) {
  const EdgeScene world(GetParam());
  const EdgeVerdict first = world.judge(world.line(4, 0.1, 0.8, 0.5, 0.5));
  const EdgeVerdict second = world.judge(world.line(5, 0.1, 0.8, 0.5, 0.5));
  const EdgeVerdict over_both = world.judge(world.line(4, 0.4, 1.4, 0.5, -0.5));
  ASSERT_EQ(first.kind, EdgeVerdict::Kind::kJudged);
  ASSERT_EQ(second.kind, EdgeVerdict::Kind::kJudged);
  ASSERT_EQ(over_both.kind, EdgeVerdict::Kind::kJudged);
  EXPECT_EQ(first.edge, second.edge);
  EXPECT_EQ(first.edge, over_both.edge);
}

TEST_P(EdgeJudgeTest, KnowsNoEdgeWhereNoneIsSeen) {
  const EdgeScene world(GetParam());
  using Kind = EdgeVerdict::Kind;
  EXPECT_EQ(world.judge(world.line(0, 0.1, 0.9, 7.0, 7.0)).kind, Kind::kNoEdge) << "too far";
  EXPECT_EQ(world.judge(world.line(0, 1.1, 1.4, 0.0, 0.0)).kind, Kind::kNoEdge) << "beyond its end";
  EXPECT_EQ(world.judge(world.line(6, 0.4, 0.6, 0.0, 0.0)).kind, Kind::kNoEdge) << "hidden by the panel";
}

INSTANTIATE_TEST_SUITE_P(Lenses, EdgeJudgeTest, testing::Values("pinhole", "euroc"));

/// Lines along edges up to 80 degrees from the axis, as a wide lens sees them, with known noise.
class WideScene {
 public:
  explicit WideScene(const std::string& lens) : camera_(makeCameraModel(calibrationOf(lens))) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    scene_.addRectangle({{-10, -10, 4}, x, y, 20, 20, -1});
    scene_.addRectangle({{2, -10, -4}, z, y, 8, 20, -1});
    scene_.addEdge({{2, -1.0, 0.4}, {2, -1.0, 3.5}});  // along the wall on the right, 30 to 79 degrees
    scene_.addEdge({{2, -1.5, 0.6}, {2, 1.5, 0.6}});   // upright beside the camera, 73 to 78 degrees
    scene_.addEdge({{-1.5, 0.8, 4}, {1.8, 1.0, 4}});   // ahead
    poses_.add(kStamp, Eigen::Isometry3d::Identity());
    poses_.sort();
    truth_ = std::make_unique<SceneTruth>(scene_, poses_, camera_);
  }

  /// Mean of the squared errors of both ends over the squared noise, of lines all along the edges.
  double normalizedSquares(double noise_px, std::size_t* judged) const {
    std::mt19937 random(9);
    std::normal_distribution<double> normal(0.0, noise_px);
    const EdgeJudge judge(*truth_);
    double squares = 0.0;
    *judged = 0;
    for (int i = 0; i < 300; ++i) {
      const TrueEdge& edge = scene_.edges()[static_cast<std::size_t>(i) % 3];
      const double from = 0.05 + 0.002 * i;
      LineFrame frame;
      frame.stamp_ns = kStamp;
      TrackedLine& line = frame.lines.emplace_back();
      const double to = from + 0.3;
      line.segment = {noisy(edge, from, normal(random)), noisy(edge, to, normal(random))};
      line.start_normalized = *camera_->normalize(line.segment.start.cast<double>());
      line.end_normalized = *camera_->normalize(line.segment.end.cast<double>());
      const EdgeVerdict verdict = judge.judge(frame).front();
      if (verdict.kind != EdgeVerdict::Kind::kJudged) continue;
      ++*judged;
      squares +=
          (verdict.start_px * verdict.start_px + verdict.end_px * verdict.end_px) / (noise_px * noise_px);
    }
    return squares / (2.0 * static_cast<double>(*judged));
  }

 private:
  /// Point of an edge in the image, off by so much across the image of the edge [px].
  Eigen::Vector2f noisy(const TrueEdge& edge, double share, double across) const {
    const auto at = [&](double s) { return *camera_->project(edge.start + s * (edge.end - edge.start)); };
    const Eigen::Vector2d along = (at(share + 1e-3) - at(share - 1e-3)).normalized();
    return (at(share) + across * Eigen::Vector2d(along.y(), -along.x())).cast<float>();
  }

  std::shared_ptr<const CameraModel> camera_;
  SceneGeometry scene_;
  PoseTrack poses_;
  std::unique_ptr<SceneTruth> truth_;
};

TEST(EdgeJudge, GivesBackTheNoiseOfPerfectLinesFarFromTheAxisOfAWideLens) {
  for (const char* lens : {"equidistant", "mei"}) {
    const WideScene world(lens);
    for (const double noise_px : {0.02, 0.3}) {
      std::size_t judged = 0;
      EXPECT_NEAR(std::sqrt(world.normalizedSquares(noise_px, &judged)), 1.0, 0.08)
          << lens << " " << noise_px;
      EXPECT_GT(judged, 290U) << lens;
    }
  }
}

TEST(EdgeJudge, MeasuresInTheImageOfALensThatLooksBeyondTheUnitPlane) {
  const EdgeScene world("equidistant");
  // Distances on z = 1 would be many times larger this far outside.
  TrackedLine line = world.line(1, 0.1, 0.9, 0.0, 0.0);
  const Eigen::Vector2f by = 1.5F * line.segment.normal();
  line.segment = {line.segment.start + by, line.segment.end + by};
  line.start_normalized = *world.camera->normalize(line.segment.start.cast<double>());
  line.end_normalized = *world.camera->normalize(line.segment.end.cast<double>());
  const EdgeVerdict verdict = world.judge(line);
  ASSERT_EQ(verdict.kind, EdgeVerdict::Kind::kJudged);
  // The chord's normal and the curve's differ a little at the ends.
  EXPECT_NEAR(std::abs(verdict.start_px), 1.5, 0.05);
  EXPECT_NEAR(std::abs(verdict.end_px), 1.5, 0.05);
}

TEST(AbsoluteMeasures, SortByLengthAndCompareErrorsWithWhatIsClaimed) {
  const EdgeScene world("euroc");
  LineFrame frame;
  frame.stamp_ns = kStamp;
  const auto add = [&](TrackedLine line, double start_sigma, double end_sigma) {
    line.id = frame.lines.size();
    line.sigma_px = 0.5F;
    if (start_sigma > 0.0) {
      line.covariance_px = {static_cast<float>(start_sigma * start_sigma), 0.0F,
                            static_cast<float>(end_sigma * end_sigma)};
    }
    frame.lines.push_back(line);
  };
  add(world.line(0, 0.05, 0.95, 0.4, 1.2), 0.2, 0.4);  // over 250 px; 2 and 3 deviations
  add(world.line(1, 0.3, 0.5, 0.3, -0.3), 0.0, 0.0);   // 45 px; no covariance: 0.6 and 0.6
  add(world.line(1, 0.6, 0.8, 0.1, 0.1), 0.1, 0.1);    // the same edge
  add(world.line(2, 0.2, 0.4, 0.0, 0.0), 0.1, 0.1);    // ambiguous
  const AbsoluteMeasures measures = measureAbsolute({frame}, *world.truth);
  EXPECT_EQ(measures.all.lines, 4U);
  EXPECT_EQ(measures.all.judged, 3U);
  EXPECT_EQ(measures.all.ambiguous, 1U);
  EXPECT_DOUBLE_EQ(measures.tracks_per_edge, 1.5);
  const AbsoluteErrors& shortest = measures.classes[0];
  EXPECT_EQ(shortest.lines, 3U);
  EXPECT_EQ(shortest.judged, 2U);
  EXPECT_NEAR(shortest.worse_median, 0.1, 1e-6);
  EXPECT_NEAR(shortest.worse_p90, 0.3, 1e-6);
  EXPECT_NEAR(shortest.middle_p90, 0.1, 1e-6);
  const AbsoluteErrors& longest = measures.classes[4];
  EXPECT_EQ(longest.judged, 1U);
  EXPECT_NEAR(longest.worse_median, 1.2, 1e-6);
  EXPECT_NEAR(longest.middle_median, 0.8, 1e-6);
  EXPECT_NEAR(longest.normalized_worse, 3.0, 1e-5);
  EXPECT_NEAR(longest.normalized_rms, std::sqrt(0.5 * (4.0 + 9.0)), 1e-5);
  EXPECT_NEAR(longest.normalized_middle, 1.6 / 0.6744898, 1e-5);
  EXPECT_NEAR(shortest.normalized_rms, std::sqrt(0.25 * (0.36 + 0.36 + 1.0 + 1.0)), 1e-5);
  EXPECT_EQ(measures.classes[2].lines, 0U);
  EXPECT_TRUE(std::isnan(measures.classes[2].worse_median));
}

TEST(LiftedSegment, LiesOnTheStraightLineBetweenTheUndistortedEndsNotOnTheChord) {
  const EdgeScene world("euroc");
  // Long and far from the centre: the chord of the raw image is pixels away from the edge.
  const TrackedLine first = world.line(0, 0.05, 0.95, 0.0, 0.0);
  TrackedLine second = first;
  const std::int64_t later = kStamp + 50000000;
  const Eigen::Isometry3d camera_from_world = world.poses.at(later)->inverse();
  const TrueEdge& edge = world.scene.edges()[0];
  const auto project = [&](double fraction) {
    return Eigen::Vector3d(camera_from_world *
                           Eigen::Vector3d(edge.start + fraction * (edge.end - edge.start)));
  };
  // Another part of the same edge, so that the chords differ.
  second.start_normalized = project(0.3).hnormalized();
  second.end_normalized = project(0.95).hnormalized();
  second.segment = {world.camera->project(project(0.3))->cast<float>(),
                    world.camera->project(project(0.95))->cast<float>()};
  const auto error = LiftedSegment(*world.truth, kStamp, first).errorOf(later, second);
  ASSERT_TRUE(error);
  EXPECT_LT(error->absolute_px, 1e-3);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  TrackedLine first_chord = first;
  TrackedLine second_chord = second;
  first_chord.start_normalized.setConstant(nan);
  second_chord.start_normalized.setConstant(nan);
  const auto chord_error = LiftedSegment(*world.truth, kStamp, first_chord).errorOf(later, second_chord);
  ASSERT_TRUE(chord_error);
  EXPECT_GT(chord_error->absolute_px, 0.3);
}

}  // namespace
}  // namespace tet_line_tracker
