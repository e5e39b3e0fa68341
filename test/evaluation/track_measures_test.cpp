#include "evaluation/track_measures.h"

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/depth_truth.h"
#include "evaluation/scene_truth.h"

namespace tet_line_tracker {
namespace {

constexpr int kImages = 41;
constexpr int kWidth = 320;
constexpr int kHeight = 240;

std::int64_t stampOf(int image) {
  return 1000000000 + static_cast<std::int64_t>(image) * 50000000;
}

/// A straight edge between two points of a surface.
struct Edge {
  int surface;
  Eigen::Vector2d from, to;
  Eigen::Vector2d at(double fraction) const { return from + fraction * (to - from); }
};

/// A wall with painted lines, a panel that stands free before it, and a panel that moves.
class World {
 public:
  explicit World(double side_step = 0.02) {
    CameraCalibration calibration;
    calibration.width = kWidth;
    calibration.height = kHeight;
    calibration.fx = calibration.fy = 250.0;
    calibration.cx = 159.5;
    calibration.cy = 119.5;
    calibration.model = "plumb_bob";
    camera = makeCameraModel(calibration);

    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    const int wall = scene.addRectangle({{-20.0, -20.0, 6.0}, x, y, 40.0, 40.0, -1});
    const Eigen::Vector3d slanted = Eigen::Vector3d(0.9, 0.0, 0.4).normalized();
    const int panel = scene.addRectangle({{-0.3, -0.4, 2.5}, slanted, y, 0.9, 0.7, -1});
    MovingBody body;
    body.origin_ns = stampOf(0);
    body.centre = {-1.05, 0.0, 3.0};
    body.swing = {0.1, 0.05, 0.2};
    body.swing_period_s = 1.3;
    body.turn_rad = 0.2;
    body.turn_period_s = 1.7;
    const int mover = scene.addRectangle({{-0.2, -0.3, 0.0}, x, y, 0.4, 0.6, scene.addBody(body)});

    painted = {{wall, {19.0, 17.9}, {21.5, 18.1}}, {wall, {21.9, 19.5}, {22.1, 21.6}}};
    outlines = {{panel, {0.0, 0.0}, {0.9, 0.0}},
                {panel, {0.9, 0.0}, {0.9, 0.7}},
                {panel, {0.9, 0.7}, {0.0, 0.7}},
                {panel, {0.0, 0.7}, {0.0, 0.0}}};
    moving = {{mover, {0.0, 0.0}, {0.0, 0.6}}, {mover, {0.4, 0.0}, {0.4, 0.6}}};

    for (int k = 0; k < kImages; ++k) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(side_step, 0.006, 0.01) * k;
      pose.linear() = (Eigen::AngleAxisd(0.004 * k, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(-0.004 * k, Eigen::Vector3d::UnitY()))
                          .toRotationMatrix();
      poses.add(stampOf(k), pose);
    }
    poses.sort();
  }

  SceneTruth truth() const { return SceneTruth(scene, poses, camera); }

  Eigen::Vector2f pixelOf(const Edge& edge, double fraction, int image) const {
    const Eigen::Vector3d point = scene.pointAt({edge.surface, edge.at(fraction)}, stampOf(image));
    return camera->project(poses.at(stampOf(image))->inverse() * point)->cast<float>();
  }

  LineSegment see(const Edge& edge, int image, double from = 0.1, double to = 0.9) const {
    return {pixelOf(edge, from, image), pixelOf(edge, to, image)};
  }

  DepthTruth depthTruth(double bad_pixels, std::int64_t delay_ns) const {
    DepthTruth truth(poses, camera);
    std::mt19937 random(1);
    for (int k = 0; k < kImages; ++k) {
      const std::int64_t stamp = stampOf(k) + delay_ns;
      const auto pose = poses.at(stamp);
      if (!pose) continue;
      cv::Mat depth(kHeight, kWidth, CV_16UC1);
      for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
          const Eigen::Vector3d ray = *camera->unproject({u, v});
          const auto hit = scene.raycast(pose->translation(), pose->linear() * ray, stamp);
          // Half of the bad pixels know nothing, the others float somewhere in the air.
          const double fate = std::uniform_real_distribution<double>(0.0, 1.0)(random);
          const double z = hit ? 1000.0 * hit->distance * ray.z() : 0.0;
          depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(fate < 0.5 * bad_pixels ? 0.0
                                                                                 : fate < bad_pixels ? 0.5 * z
                                                                                                     : z));
        }
      }
      truth.addDepth(stamp, depth);
    }
    return truth;
  }

  SceneGeometry scene;
  PoseTrack poses;
  std::shared_ptr<const CameraModel> camera;
  std::vector<Edge> painted, outlines, moving;
};

std::vector<Edge> operator+(std::vector<Edge> a, const std::vector<Edge>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// One track per edge; `see` gives its segment in an image, or one of length 0 where the track has ended.
std::vector<LineFrame> tracks(const std::vector<Edge>& edges,
                              const std::function<LineSegment(const Edge&, int)>& see) {
  std::vector<LineFrame> frames;
  for (int k = 0; k < kImages; ++k) {
    LineFrame& frame = frames.emplace_back();
    frame.stamp_ns = stampOf(k);
    frame.image_count = static_cast<std::uint64_t>(k) + 1;
    frame.width = kWidth;
    frame.height = kHeight;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      TrackedLine line;
      line.id = i;
      line.age = static_cast<std::uint32_t>(k) + 1;
      line.segment = see(edges[i], k);
      if (line.segment.length() > 0.0F) frame.lines.push_back(line);
    }
  }
  return frames;
}

/// Moved by `px` along the normal.
LineSegment shifted(const LineSegment& segment, double px) {
  const Eigen::Vector2f by = static_cast<float>(px) * segment.normal();
  return {segment.start + by, segment.end + by};
}

constexpr double kRounding = 2e-3;  // endpoints are float32

TEST(TrackMeasures, GiveFullMarksToTheTruthItself) {
  const World world;
  const SceneTruth truth = world.truth();
  const auto frames = tracks(world.painted + world.outlines + world.moving,
                             [&](const Edge& edge, int k) { return world.see(edge, k); });
  const TrackMeasures measures = measureTracks(frames, false, &truth);
  EXPECT_EQ(measures.images, 41U);
  EXPECT_EQ(measures.tracks, 8U);
  EXPECT_EQ(measures.judged_pairs, 8U * 40U);
  EXPECT_EQ(measures.unjudged_pairs, 0U);
  EXPECT_EQ(measures.inlier_ratio, 1.0);
  EXPECT_EQ(measures.tight_inlier_ratio, 1.0);
  EXPECT_LT(measures.p95_error, kRounding);
  for (const double drift : measures.drift_p95) EXPECT_LT(drift, kRounding);
  EXPECT_EQ(measures.clean_length, 41.0);
  EXPECT_EQ(measures.track_length, 41.0);
  EXPECT_EQ(measures.survival, 1.0);
}

TEST(TrackMeasures, GiveFullMarksToLinesThatSlideAlongTheirEdge) {
  const World world;
  const SceneTruth truth = world.truth();
  const auto frames = tracks(world.painted + world.outlines + world.moving, [&](const Edge& edge, int k) {
    const double slide = 0.1 * std::sin(0.7 * k);
    return world.see(edge, k, 0.12 + slide, 0.88 + 0.5 * slide);
  });
  const TrackMeasures measures = measureTracks(frames, false, &truth);
  EXPECT_EQ(measures.judged_pairs, 8U * 40U);
  EXPECT_EQ(measures.tight_inlier_ratio, 1.0);
  EXPECT_LT(measures.p95_error, kRounding);
  EXPECT_LT(measures.drift_p95[3], kRounding);
  EXPECT_EQ(measures.survival, 1.0);
}

TEST(TrackMeasures, GiveNothingToLinesThatAreThreePixelsOff) {
  const World world(0.008);  // with little parallax: beside an outline a line shows the wall behind
  const SceneTruth truth = world.truth();
  // Off to the one and to the other side: frame to frame by 3 px as well as from the first image on.
  const auto frames = tracks(world.painted + world.outlines, [&](const Edge& edge, int k) {
    return shifted(world.see(edge, k), k % 2 == 0 ? 0.0 : 3.0);
  });
  const TrackMeasures measures = measureTracks(frames, false, &truth);
  EXPECT_EQ(measures.judged_pairs, 6U * 40U);
  EXPECT_EQ(measures.inlier_ratio, 0.0);
  EXPECT_NEAR(measures.median_error, 3.0, 0.2);
  EXPECT_EQ(measures.clean_length, 1.0);
  // Every second image is right, the ones between are not.
  EXPECT_NEAR(measures.survival, 0.5, 0.02);
}

TEST(TrackMeasures, CountTheImagesUntilADriftingTrackPassesTwoPixels) {
  const World world;
  const SceneTruth truth = world.truth();
  const auto frames =
      tracks(world.painted, [&](const Edge& edge, int k) { return shifted(world.see(edge, k), 0.15 * k); });
  const TrackMeasures measures = measureTracks(frames, false, &truth);
  EXPECT_EQ(measures.inlier_ratio, 1.0);
  EXPECT_NEAR(measures.median_error, 0.15, 0.01);
  EXPECT_NEAR(measures.drift[0], 0.6, 0.03);
  EXPECT_NEAR(measures.drift[1], 1.35, 0.05);
  EXPECT_EQ(measures.clean_length, 14.0);  // 13 steps are 1.95 px, 14 are 2.1 px
  EXPECT_NEAR(measures.survival, 13.0 / 40.0, 0.001);
}

TEST(TrackMeasures, CountLostTracksAgainstSurvivalAndNewIdsAsNewTracks) {
  const World world;
  const SceneTruth truth = world.truth();
  const LineSegment none;
  const auto half =
      tracks(world.painted, [&](const Edge& edge, int k) { return k <= 20 ? world.see(edge, k) : none; });
  EXPECT_DOUBLE_EQ(measureTracks(half, false, &truth).survival, 0.5);

  auto renamed = tracks(world.painted, [&](const Edge& edge, int k) { return world.see(edge, k); });
  for (std::size_t k = 21; k < renamed.size(); ++k) {
    for (TrackedLine& line : renamed[k].lines) line.id += 100;
  }
  const TrackMeasures measures = measureTracks(renamed, false, &truth);
  EXPECT_EQ(measures.tracks, 4U);
  EXPECT_DOUBLE_EQ(measures.survival, (20.0 + 19.0) / (40.0 + 19.0));
}

TEST(TrackMeasures, EndSurvivalWhenHalfOfTheSegmentHasLeftTheView) {
  const World world(0.25);  // the painted lines leave the picture
  const SceneTruth truth = world.truth();
  const auto frames = tracks(world.painted, [&](const Edge& edge, int k) { return world.see(edge, k); });
  const TrackMeasures measures = measureTracks(frames, false, &truth);
  ASSERT_FALSE(measures.survival_curve.in_view.empty());
  EXPECT_LT(measures.survival_curve.in_view.size(), 40U);
  EXPECT_EQ(measures.survival, 1.0);

  MeasureOptions long_lines;
  long_lines.min_length = 1000.0;
  EXPECT_TRUE(measureTracks(frames, false, &truth, long_lines).survival_curve.in_view.empty());
}

TEST(TrackMeasures, FindThatAnHonestSigmaSpreadsByOne) {
  const World world;
  const SceneTruth truth = world.truth();
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.3);
  auto frames = tracks(world.painted,
                       [&](const Edge& edge, int k) { return shifted(world.see(edge, k), noise(random)); });
  EXPECT_TRUE(std::isnan(measureTracks(frames, false, &truth).sigma_spread));
  for (LineFrame& frame : frames) {
    for (TrackedLine& line : frame.lines) line.sigma_px = 0.3F;
  }
  EXPECT_NEAR(measureTracks(frames, false, &truth).sigma_spread, 1.0, 0.2);
  for (LineFrame& frame : frames) {
    for (TrackedLine& line : frame.lines) line.sigma_px = 0.1F;
  }
  EXPECT_NEAR(measureTracks(frames, false, &truth).sigma_spread, 3.0, 0.6);
}

TEST(TrackMeasures, CountOnlyWhatCanBeCountedWithoutTruth) {
  const World world;
  auto frames =
      tracks(world.painted + world.outlines, [&](const Edge& edge, int k) { return world.see(edge, k); });
  for (LineFrame& frame : frames) frame.statistics.total_ms = static_cast<double>(frame.image_count);
  const TrackMeasures measures = measureTracks(frames, true, nullptr);
  EXPECT_EQ(measures.lines_per_image, 6.0);
  EXPECT_EQ(measures.matches_per_pair, 6.0);
  EXPECT_EQ(measures.track_length, 41.0);
  EXPECT_DOUBLE_EQ(measures.ms_mean, 21.0);
  EXPECT_DOUBLE_EQ(measures.ms_p99, 41.0);
  EXPECT_TRUE(std::isnan(measures.inlier_ratio));
  EXPECT_TRUE(std::isnan(measures.survival));
}

TEST(TrackMeasures, FindTheGridCellsThatALineCrosses) {
  LineFrame frame;
  frame.width = 320;
  frame.height = 240;
  EXPECT_EQ(gridCoverage(frame), 0.0);
  TrackedLine line;
  line.segment = {{5.0F, 20.0F}, {315.0F, 20.0F}};  // the whole upper row
  frame.lines.push_back(line);
  EXPECT_NEAR(gridCoverage(frame), 8.0 / 48.0, 1e-7);
  line.segment = {{60.0F, 50.0F}, {60.0F, 110.0F}};  // two cells further down
  frame.lines.push_back(line);
  EXPECT_NEAR(gridCoverage(frame), 10.0 / 48.0, 1e-7);
}

class DepthTruthTest : public testing::TestWithParam<std::pair<double, std::int64_t>> {};

TEST_P(DepthTruthTest, JudgesLikeTheExactScene) {
  const World world(0.008);
  const auto [bad_pixels, delay_ns] = GetParam();
  const DepthTruth truth = world.depthTruth(bad_pixels, delay_ns);
  const std::vector<Edge> edges = world.painted + world.outlines;
  const auto good = tracks(edges, [&](const Edge& edge, int k) {
    const double slide = 0.1 * std::sin(0.7 * k);
    return world.see(edge, k, 0.12 + slide, 0.88 + 0.5 * slide);
  });
  const TrackMeasures measures = measureTracks(good, false, &truth);
  EXPECT_GE(measures.judged_pairs, 6U * 39U);
  EXPECT_EQ(measures.inlier_ratio, 1.0);
  EXPECT_LT(measures.p95_error, 0.1);
  EXPECT_LT(measures.drift[3], 0.2);
  EXPECT_GT(measures.survival, 0.99);

  const auto bad = tracks(
      edges, [&](const Edge& edge, int k) { return shifted(world.see(edge, k), k % 2 == 0 ? 0.0 : 3.0); });
  EXPECT_EQ(measureTracks(bad, false, &truth).inlier_ratio, 0.0);
}

INSTANTIATE_TEST_SUITE_P(BadPixelsAndDelays, DepthTruthTest,
                         testing::Values(std::make_pair(0.0, 0), std::make_pair(0.2, 0),
                                         std::make_pair(0.0, 12000000), std::make_pair(0.2, -12000000)));

}  // namespace
}  // namespace tet_line_tracker
