#include "evaluation/true_lines.h"

#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kFirst = 1000000000;
constexpr std::int64_t kPeriod = 50000000;
constexpr double kFocal = 400.0;

/// A wall 4 m ahead of a camera that moves along x by 0.1 m per image, with edges on it, and a panel at 2 m
/// that hides x from 2 to 3 of a camera at 0.
std::unique_ptr<SceneTruth> wall(const std::vector<TrueEdge>& edges) {
  SceneGeometry scene;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  scene.addRectangle({{-10, -10, 4}, x, y, 20, 20, -1});
  scene.addRectangle({{1, -5, 2}, x, y, 0.5, 10, -1});
  for (const TrueEdge& edge : edges) scene.addEdge(edge);
  PoseTrack poses;
  for (int i = 0; i < 40; ++i) {
    poses.add(kFirst + i * kPeriod, Eigen::Isometry3d(Eigen::Translation3d(0.1 * i, 0.0, 0.0)));
  }
  poses.sort();
  CameraCalibration camera;
  camera.model = "plumb_bob";
  camera.width = 752;
  camera.height = 480;
  camera.fx = camera.fy = kFocal;
  camera.cx = 375.5;
  camera.cy = 239.5;
  camera.distortion = {-0.28, 0.07, 0.0, 0.0};
  return std::make_unique<SceneTruth>(std::move(scene), poses, makeCameraModel(camera));
}

TrueLinesOptions exact(int max_lines = 60) {
  TrueLinesOptions options;
  options.noise_px = 0.0;
  options.max_lines = max_lines;
  return options;
}

TEST(TrueLines, EndsLieOnTheEdgeAndKeepTheirRolesAndTheirId) {
  const auto truth = wall({{{-1.0, 0.5, 4.0}, {0.5, 0.7, 4.0}}});
  TrueLines lines(*truth, exact());
  for (int i = 0; i < 8; ++i) {
    const LineFrame frame = lines.next(kFirst + i * kPeriod);
    ASSERT_EQ(frame.lines.size(), 1U);
    const TrackedLine& line = frame.lines[0];
    EXPECT_EQ(line.id, 0U);
    EXPECT_EQ(line.age, static_cast<std::uint32_t>(i) + 1);
    const Eigen::Vector2d start(Eigen::Vector2d(-1.0 - 0.1 * i, 0.5) / 4.0);
    const Eigen::Vector2d end(Eigen::Vector2d(0.5 - 0.1 * i, 0.7) / 4.0);
    EXPECT_LT((line.start_normalized - start).norm() * kFocal, 0.01);
    EXPECT_LT((line.end_normalized - end).norm() * kFocal, 0.01);
  }
}

TEST(TrueLines, GiveOfAnEdgeWhatIsNotHiddenAndInThePicture) {
  const auto truth = wall({{{0.0, 0.5, 4.0}, {20.0, 0.5, 4.0}}});
  TrueLines lines(*truth, exact());
  const LineFrame frame = lines.next(kFirst);
  ASSERT_EQ(frame.lines.size(), 1U);
  EXPECT_NEAR(4.0 * frame.lines[0].start_normalized.x(), 0.0, 0.06);
  EXPECT_NEAR(4.0 * frame.lines[0].end_normalized.x(), 2.0, 0.06);  // the panel begins there
}

TEST(TrueLines, AnEdgeThatWasHiddenReturnsUnderANewId) {
  // Behind the panel while the camera moves past.
  const auto truth = wall({{{1.5, -0.4, 4.0}, {1.5, 0.4, 4.0}}});
  TrueLines lines(*truth, exact());
  std::vector<std::uint64_t> ids;  // of the images in turn; kNone: hidden
  constexpr std::uint64_t kNone = 99;
  for (int i = 0; i < 30; ++i) {
    const LineFrame frame = lines.next(kFirst + i * kPeriod);
    const std::uint64_t id = frame.lines.empty() ? kNone : frame.lines[0].id;
    if (ids.empty() || ids.back() != id) ids.push_back(id);
  }
  EXPECT_EQ(ids, (std::vector<std::uint64_t>{0, kNone, 1}));
}

std::set<std::uint64_t> idsOf(const LineFrame& frame) {
  std::set<std::uint64_t> ids;
  for (const TrackedLine& line : frame.lines) ids.insert(line.id);
  return ids;
}

TEST(TrueLines, FillUpWithTheLongest) {
  // The long edge at the left leaves the picture; the short ones stay.
  const auto truth = wall({{{-0.5, 0.2, 4.0}, {0.2, 0.2, 4.0}},
                           {{-0.5, 0.4, 4.0}, {0.4, 0.4, 4.0}},
                           {{-4.7, -0.9, 4.0}, {-4.7, 0.9, 4.0}}});
  TrueLines lines(*truth, exact(2));
  EXPECT_EQ(idsOf(lines.next(kFirst)), (std::set<std::uint64_t>{0, 1}));
  std::set<std::uint64_t> last;
  for (int i = 1; i < 12; ++i) last = idsOf(lines.next(kFirst + i * kPeriod));
  EXPECT_EQ(last, (std::set<std::uint64_t>{1, 2}));
}

TEST(TrueLines, KeepWhatTheyHaveWhenALongerEdgeComesIntoView) {
  const std::vector<TrueEdge> edges{{{-0.5, 0.4, 4.0}, {0.0, 0.4, 4.0}}, {{5.2, -0.9, 4.0}, {5.2, 0.9, 4.0}}};
  const auto truth = wall(edges);
  TrueLines all(*truth, exact());
  TrueLines one(*truth, exact(1));
  EXPECT_EQ(idsOf(all.next(kFirst)).size(), 1U);
  EXPECT_EQ(idsOf(one.next(kFirst)), std::set<std::uint64_t>{0});
  std::size_t in_view = 0;
  for (int i = 1; i < 12; ++i) {
    in_view = idsOf(all.next(kFirst + i * kPeriod)).size();
    EXPECT_EQ(idsOf(one.next(kFirst + i * kPeriod)), std::set<std::uint64_t>{0});
  }
  EXPECT_EQ(in_view, 2U);
}

TEST(TrueLines, NoiseIsAcrossTheLineAsLargeAsAskedAndNewInEachImage) {
  const auto truth = wall({{{-0.5, 0.0, 4.0}, {0.5, 0.0, 4.0}}});
  TrueLinesOptions options;
  options.noise_px = 0.5;
  TrueLines lines(*truth, options);
  TrueLines without(*truth, exact());
  double squares = 0.0;
  constexpr int kRepeats = 400;
  for (int i = 0; i < kRepeats; ++i) {
    const LineSegment noisy = lines.next(kFirst).lines.at(0).segment;
    const LineSegment ideal = without.next(kFirst).lines.at(0).segment;
    squares += static_cast<double>((noisy.start - ideal.start).squaredNorm());
    EXPECT_NEAR(noisy.start.x(), ideal.start.x(), 1e-3);
  }
  EXPECT_NEAR(std::sqrt(squares / kRepeats), 0.5, 0.06);
}

TEST(TrueLines, RefuseOptionsWithoutMeaning) {
  const auto truth = wall({});
  TrueLinesOptions options;
  options.max_lines = 0;
  EXPECT_THROW(TrueLines(*truth, options), std::invalid_argument);
  options = exact();
  options.noise_px = -0.1;
  EXPECT_THROW(TrueLines(*truth, options), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker
