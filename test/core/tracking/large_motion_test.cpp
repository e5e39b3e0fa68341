// LineTracker where the camera moves far between two images, past things at different depths.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "scene_images.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

using Pose = BoardScene::Pose;
using Edge = std::pair<std::size_t, int>;  ///< board and side

/// The side of a board on which a line lies, if there is one and no other.
std::optional<Edge> edgeOf(const BoardScene& scene, const Pose& pose, const LineSegment& line) {
  std::optional<Edge> found;
  for (std::size_t b = 0; b < scene.boards().size(); ++b) {
    const auto corners = BoardScene::cornersOf(scene.boards()[b], pose);
    if (!corners) continue;
    for (int side = 0; side < 4; ++side) {
      const LineSegment edge{(*corners)[static_cast<std::size_t>(side)].cast<float>(),
                             (*corners)[static_cast<std::size_t>((side + 1) % 4)].cast<float>()};
      const Eigen::Vector2f along = edge.direction();
      const auto isOn = [&](const Eigen::Vector2f& point) {
        const float at = along.dot(point - edge.start);
        return std::abs(edge.distance(point)) < 1.0F && at > -4.0F && at < edge.length() + 4.0F;
      };
      if (!isOn(line.start) || !isOn(line.end)) continue;
      if (found) return std::nullopt;
      found = Edge(b, side);
    }
  }
  return found;
}

struct Outcome {
  int pairs{0};  ///< lines of known edges that are tracked into the next image
  int lost{0};   ///< lines of known edges that are not, though the edge is in the view
  int wrong{0};  ///< of `pairs`, those on another edge
  double keptShare() const { return static_cast<double>(pairs - wrong) / (pairs + lost); }
};

/// 8 images of `scene` from one to the next of which the camera makes `step` [m] and turns by `turn` [rad].
Outcome fly(const BoardScene& scene, const LineTrackerParameters& parameters, const Eigen::Vector3d& step,
            double turn) {
  LineTracker tracker(parameters);
  tracker.setCamera(BoardScene::camera());
  Outcome outcome;
  std::map<std::uint64_t, Edge> before;
  for (int k = 0; k < 8; ++k) {
    // To and fro, so that the same boards stay in view.
    const double place = k % 4 < 2 ? k % 4 : 4 - k % 4;
    const Pose pose{place * step,
                    Eigen::AngleAxisd(place * turn, Eigen::Vector3d::UnitY()).toRotationMatrix()};
    const LineFrame* frame =
        tracker.process(scene.image(pose), 1000000000 + 100000000 * std::int64_t{k}).frame;
    std::map<std::uint64_t, Edge> now;
    std::map<std::uint64_t, bool> live;
    for (const TrackedLine& line : frame->lines) {
      live[line.id] = true;
      const auto edge = edgeOf(scene, pose, line.segment);
      if (edge) now.emplace(line.id, *edge);
      const auto last = before.find(line.id);
      if (last == before.end() || !edge) continue;
      ++outcome.pairs;
      if (last->second != *edge) ++outcome.wrong;
    }
    for (const auto& [id, edge] : before) {
      if (live.count(id) != 0) continue;
      const auto corners = BoardScene::cornersOf(scene.boards()[edge.first], pose);
      const auto isIn = [](const Eigen::Vector2d& point) {
        return point.x() > 10.0 && point.y() > 10.0 && point.x() < BoardScene::kWidth - 10.0 &&
               point.y() < BoardScene::kHeight - 10.0;
      };
      if (corners && isIn((*corners)[static_cast<std::size_t>(edge.second)]) &&
          isIn((*corners)[static_cast<std::size_t>((edge.second + 1) % 4)])) {
        ++outcome.lost;
      }
    }
    before = std::move(now);
  }
  return outcome;
}

/// The sum over six scenes: one scene's share differs by 0.2 from another's.
Outcome flyThroughScenes(const LineTrackerParameters& parameters, const Eigen::Vector3d& step, double turn) {
  Outcome sum;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Outcome outcome = fly(BoardScene::random(seed), parameters, step, turn);
    sum.pairs += outcome.pairs;
    sum.lost += outcome.lost;
    sum.wrong += outcome.wrong;
  }
  return sum;
}

TEST(LargeMotion, LinesAreKeptPastNearThingsThatMoveFartherThanTheFlowReaches) {
  // Near boards move by 70 px, far ones by 16; the rotation alone explains none of it.
  LineTrackerParameters parameters;
  const Outcome with = flyThroughScenes(parameters, {0.3, 0.05, 0.1}, 0.0);
  parameters.motion.ego_motion = false;
  const Outcome without = flyThroughScenes(parameters, {0.3, 0.05, 0.1}, 0.0);
  EXPECT_GT(with.pairs, 1000);
  EXPECT_GT(with.keptShare(), 0.70);
  EXPECT_GT(with.keptShare(), without.keptShare() + 0.4);
  EXPECT_LE(with.wrong, with.pairs / 50);
}

TEST(LargeMotion, LinesAreKeptWhereTheCameraTurnsBesides) {
  const Outcome outcome = flyThroughScenes({}, {0.15, 0.0, 0.15}, 0.04);
  EXPECT_GT(outcome.pairs, 1500);
  EXPECT_GT(outcome.keptShare(), 0.82);
  EXPECT_LE(outcome.wrong, outcome.pairs / 50);
}

TEST(LargeMotion, TheStatisticsTellTheDirection) {
  const BoardScene scene = BoardScene::random(3);
  LineTracker tracker{LineTrackerParameters()};
  tracker.setCamera(BoardScene::camera());
  tracker.process(scene.image({}), 1000000000);
  const LineFrame* frame = tracker.process(scene.image({{0.15, 0.0, 0.0}}), 1100000000).frame;
  EXPECT_LT(frame->statistics.translation[0], -0.98F)
      << "points move to the left of a camera that goes right";
  EXPECT_GT(frame->statistics.translation_inliers, 20U);
}

TEST(LargeMotion, AThingThatMovesItselfIsFoundWhereTheCameraIsKnownToStandStill) {
  const BoardScene scene = BoardScene::random(3);
  const cv::Mat still = scene.image(Pose{});
  const auto imageWith = [&](int left) {
    cv::Mat image = still.clone();
    cv::rectangle(image, cv::Rect(left, 150, 90, 120), cv::Scalar(250), cv::FILLED);
    return image;
  };
  LineTracker tracker(LineTrackerParameters{});
  tracker.setCamera(BoardScene::camera());
  std::int64_t stamp = 1000000000;
  std::map<std::uint64_t, LineSegment> before;
  for (int k = 0; k < 4; ++k) {
    before.clear();
    for (const TrackedLine& line : tracker.process(imageWith(280), stamp += 50000000).frame->lines) {
      before[line.id] = line.segment;
    }
  }
  // Farther than the finest level of the flow reaches.
  constexpr int kMovement = 12;
  int found = 0;
  for (const TrackedLine& line :
       tracker.process(imageWith(280 + kMovement), stamp += 50000000).frame->lines) {
    const auto old = before.find(line.id);
    if (old == before.end()) continue;
    const Eigen::Vector2f moved = line.segment.middle() - old->second.middle();
    if (std::abs(moved.x() - kMovement) < 1.0F && std::abs(line.segment.direction().y()) > 0.95F) ++found;
  }
  EXPECT_EQ(found, 2);
}

}  // namespace
}  // namespace tet_line_tracker
