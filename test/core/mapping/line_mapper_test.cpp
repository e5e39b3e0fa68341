#include "tet_line_tracker/mapping/line_mapper.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr double kFocal = 450.0;  // [px]

/// A camera that looks along z while it moves sideways and a little up, far from the world's origin.
Eigen::Isometry3d poseAt(int image) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(100.0 + 0.05 * image, -50.0 + 0.02 * image, 3.0);
  pose.linear() = Eigen::AngleAxisd(0.01 * image, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return pose;
}

/// Pixel noise across the line at both ends.
TrackedLine seen(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const Eigen::Isometry3d& pose,
                 std::uint32_t age, double noise_start_px = 0.0, double noise_end_px = 0.0) {
  TrackedLine line;
  line.age = age;
  line.start_normalized = (pose.inverse() * start).hnormalized();
  line.end_normalized = (pose.inverse() * end).hnormalized();
  const Eigen::Vector2d along = (line.end_normalized - line.start_normalized).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  line.start_normalized += noise_start_px / kFocal * across;
  line.end_normalized += noise_end_px / kFocal * across;
  line.segment = {(kFocal * line.start_normalized).cast<float>(),
                  (kFocal * line.end_normalized).cast<float>()};
  line.sigma_px = 0.3F;
  return line;
}

/// For noise that differs from image to image.
LineMapperParameters independentViews() {
  LineMapperParameters parameters;
  parameters.correlated_views = 1.0;
  return parameters;
}

LineFrame frameOf(int image, std::vector<TrackedLine> lines) {
  LineFrame frame;
  frame.stamp_ns = 50000000LL * image;
  frame.image_count = static_cast<std::uint64_t>(image) + 1;
  frame.lines = std::move(lines);
  return frame;
}

const Eigen::Vector3d kStart(99.5, -50.4, 6.0);
const Eigen::Vector3d kEnd(100.7, -49.1, 6.8);

TEST(PlueckerLine, MovesAsItsDerivativesSay) {
  const PlueckerLine line =
      PlueckerLine::through({0.3, -1.2, 2.5}, Eigen::Vector3d(0.2, 0.9, -0.3).normalized());
  EXPECT_LT((line.foot().cross(line.direction) - line.moment).norm(), 1e-12);
  const auto derivatives = line.derivatives();
  for (int i = 0; i < 4; ++i) {
    constexpr double kStep = 1e-6;
    const PlueckerLine moved = line.moved(kStep * Eigen::Vector4d::Unit(i));
    EXPECT_NEAR(moved.direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(moved.direction.dot(moved.moment), 0.0, 1e-12);
    // The scale of both is free: compare what it does not touch.
    Eigen::Matrix<double, 6, 1> predicted;
    predicted << line.moment, line.direction;
    predicted += kStep * derivatives.col(i);
    predicted /= predicted.tail<3>().norm();
    EXPECT_LT((predicted.head<3>() - moved.moment).norm(), 1e-10) << i;
    EXPECT_LT((predicted.tail<3>() - moved.direction).norm(), 1e-10) << i;
  }
}

TEST(LineMapper, FindsALineFromExactViews) {
  LineMapper mapper(independentViews());
  for (int i = 0; i < 20; ++i) {
    mapper.add(frameOf(i, {seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1)}), poseAt(i));
  }
  auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_FALSE(lines[0].finished);
  mapper.finish();
  lines = mapper.lines();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].finished);
  EXPECT_LT((lines[0].start - kStart).norm(), 1e-5);  // 32-bit pixels only enter the weights
  EXPECT_LT((lines[0].end - kEnd).norm(), 1e-5);
  EXPECT_LT(lines[0].reprojection_px, 1e-5);
  EXPECT_EQ(lines[0].views, 20);
  EXPECT_NEAR(lines[0].distance, 3.5, 0.3);
}

TEST(LineMapper, IsAsSureAsTheNoiseAllows) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.3);
  LineMapperParameters parameters = independentViews();
  parameters.sigma_floor = 0.0;
  LineMapper mapper(parameters);
  constexpr int kLines = 300;
  double squares = 0.0;
  int mapped = 0;
  for (int k = 0; k < kLines; ++k) {
    LineFrame frame;
    for (int i = 0; i < 20; ++i) {
      TrackedLine line =
          seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1, noise(random), noise(random));
      line.id = static_cast<std::uint64_t>(k);
      mapper.add(frameOf(i, {line}), poseAt(i));
    }
    mapper.finish();
  }
  const Eigen::Vector3d direction = (kEnd - kStart).normalized();
  for (const MappedLine& line : mapper.lines()) {
    const Eigen::Vector3d off = line.start - kStart;
    const double across = (off - off.dot(direction) * direction).norm();
    squares += std::pow(across / line.sigma_start, 2);
    ++mapped;
  }
  ASSERT_GT(mapped, kLines * 9 / 10);
  // Between 1 (all error in the worst direction) and 2 (as large in the other), with room for chance.
  EXPECT_GT(squares / mapped, 0.8);
  EXPECT_LT(squares / mapped, 2.2);
}

TEST(LineMapper, IsAsSureOfEachEndAsItsCovarianceSays) {
  std::mt19937 random(4);
  std::normal_distribution<double> start_noise(0.0, 0.1);
  std::normal_distribution<double> end_noise(0.0, 0.8);
  LineMapperParameters parameters = independentViews();
  parameters.sigma_floor = 0.0;
  parameters.max_sigma = 1.0;
  LineMapper mapper(parameters);
  constexpr int kLines = 200;
  for (int k = 0; k < kLines; ++k) {
    for (int i = 0; i < 20; ++i) {
      TrackedLine line = seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1, start_noise(random),
                              end_noise(random));
      line.id = static_cast<std::uint64_t>(k);
      line.covariance_px = {0.01F, 0.0F, 0.64F};
      mapper.add(frameOf(i, {line}), poseAt(i));
    }
    mapper.finish();
  }
  const Eigen::Vector3d direction = (kEnd - kStart).normalized();
  const auto across = [&](const Eigen::Vector3d& off) {
    return (off - off.dot(direction) * direction).norm();
  };
  double start_squares = 0.0;
  double end_squares = 0.0;
  const auto lines = mapper.lines();
  ASSERT_GT(lines.size(), kLines * 9U / 10U);
  for (const MappedLine& line : lines) {
    EXPECT_LT(line.sigma_start, 0.5 * line.sigma_end);
    start_squares += std::pow(across(line.start - kStart) / line.sigma_start, 2);
    end_squares += std::pow(across(line.end - kEnd) / line.sigma_end, 2);
  }
  for (const double squares : {start_squares, end_squares}) {
    EXPECT_GT(squares / static_cast<double>(lines.size()), 0.8);
    EXPECT_LT(squares / static_cast<double>(lines.size()), 2.2);
  }
}

TEST(LineMapper, TakesTheLongerPartOfFirstAndLastView) {
  LineMapper mapper(independentViews());
  const Eigen::Vector3d middle = 0.5 * (kStart + kEnd);
  for (int i = 0; i < 20; ++i) {
    const auto age = static_cast<std::uint32_t>(i) + 1;
    mapper.add(
        frameOf(i, {i == 19 ? seen(middle, kEnd, poseAt(i), age) : seen(kStart, middle, poseAt(i), age)}),
        poseAt(i));
  }
  const auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT((lines[0].start - kStart).norm(), 1e-5);
  EXPECT_LT((lines[0].end - kEnd).norm(), 1e-5);
}

TEST(LineMapper, OutvotesWrongViews) {
  LineMapperParameters parameters;
  parameters.max_reprojection = 20.0;
  LineMapper mapper(parameters);
  for (int i = 0; i < 40; ++i) {
    const double wrong = i % 10 == 5 ? 40.0 : 0.0;
    mapper.add(frameOf(i, {seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1, wrong, wrong)}),
               poseAt(i));
  }
  const auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT((lines[0].start - kStart).norm(), 0.01);
}

TEST(LineMapper, RejectsWhatCannotBeALineInSpace) {
  const auto rejected = [](const auto& pose_of, const auto& line_of, int images) {
    LineMapper mapper(independentViews());
    for (int i = 0; i < images; ++i) mapper.add(frameOf(i, {line_of(i)}), pose_of(i));
    mapper.finish();
    EXPECT_TRUE(mapper.lines().empty());
    return mapper.rejected();
  };
  const auto still = [](int) { return poseAt(0); };
  const auto good = [](int i) { return seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1); };
  EXPECT_EQ(rejected(poseAt, good, 4).few_views, 1U);
  EXPECT_EQ(
      rejected(
          still, [](int i) { return seen(kStart, kEnd, poseAt(0), static_cast<std::uint32_t>(i) + 1); }, 20)
          .parallax,
      1U);
  // Moves in the world.
  EXPECT_EQ(rejected(
                poseAt,
                [](int i) {
                  const Eigen::Vector3d away(0.0, 0.002 * i * i, 0.0);
                  return seen(kStart + away, kEnd + away, poseAt(i), static_cast<std::uint32_t>(i) + 1);
                },
                20)
                .reprojection,
            1U);
  const Eigen::Vector3d far(0.0, 0.0, 30.0);
  const LineMapper::Rejected distant =
      rejected([](int i) { return poseAt(10 * i); },
               [&](int i) {
                 return seen(kStart + far, kEnd + far, poseAt(10 * i), static_cast<std::uint32_t>(i) + 1);
               },
               20);
  EXPECT_EQ(distant.ends + distant.sigma, 1U);
}

/// What becomes of a line whose camera moves `share` as far as in the other tests.
template <class LineOf>
LineMapper::Rejected rejectedOf(const LineMapperParameters& parameters, double share, const LineOf& line_of,
                                std::size_t mapped) {
  LineMapper mapper(parameters);
  const Eigen::Vector3d first = poseAt(0).translation();
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d pose = poseAt(i);
    pose.translation() = first + share * (pose.translation() - first);
    mapper.add(frameOf(i, {line_of(pose, static_cast<std::uint32_t>(i) + 1)}), pose);
  }
  mapper.finish();
  EXPECT_EQ(mapper.lines().size(), mapped);
  return mapper.rejected();
}

TEST(LineMapper, RejectsALineSeenFromOneDirectionAlone) {
  LineMapperParameters parameters;
  parameters.max_sigma = 100.0;
  const auto exact = [](const Eigen::Isometry3d& pose, std::uint32_t age) {
    return seen(kStart, kEnd, pose, age);
  };
  constexpr double kShare = 0.1;  // the two outermost viewing planes are about 1 degree apart
  EXPECT_EQ(rejectedOf(parameters, kShare, exact, 0).parallax, 1U);
  parameters.min_parallax = 0.3;
  EXPECT_EQ(rejectedOf(parameters, kShare, exact, 1).parallax, 0U);
}

TEST(LineMapper, RejectsALineThatIsNotSureEnough) {
  LineMapperParameters parameters;
  const auto vague = [](const Eigen::Isometry3d& pose, std::uint32_t age) {
    TrackedLine line = seen(kStart, kEnd, pose, age);
    line.sigma_px = 10.0F;
    return line;
  };
  EXPECT_EQ(rejectedOf(parameters, 1.0, vague, 0).sigma, 1U);
  parameters.max_sigma = 100.0;
  EXPECT_EQ(rejectedOf(parameters, 1.0, vague, 1).sigma, 0U);
}

TEST(LineMapper, RejectsALineBehindTheCameraOrTooFarAway) {
  LineMapperParameters parameters = independentViews();
  // The projection of a point behind the camera is that of one before it.
  const auto behind = [](const Eigen::Isometry3d& pose, std::uint32_t age) {
    const Eigen::Vector3d back(0.0, 0.0, -7.0);
    return seen(kStart + back, kEnd + back, pose, age);
  };
  EXPECT_EQ(rejectedOf(parameters, 1.0, behind, 0).ends, 1U);
  const auto exact = [](const Eigen::Isometry3d& pose, std::uint32_t age) {
    return seen(kStart, kEnd, pose, age);
  };
  EXPECT_EQ(rejectedOf(parameters, 1.0, exact, 1).ends, 0U);
  parameters.max_distance = 2.5;
  EXPECT_EQ(rejectedOf(parameters, 1.0, exact, 0).ends, 1U);
}

/// Deviation of the start of the line of 100 views.
double sigmaWith(const LineMapperParameters& parameters) {
  LineMapper mapper(parameters);
  for (int i = 0; i < 100; ++i) {
    mapper.add(frameOf(i, {seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1)}), poseAt(i));
  }
  const auto lines = mapper.lines();
  EXPECT_EQ(lines.size(), 1U);
  return lines.empty() ? 0.0 : lines[0].sigma_start;
}

TEST(LineMapper, CountsImagesInARowThatErrAlikeAsOne) {
  LineMapperParameters parameters = independentViews();
  parameters.max_views = 1000;
  const double independent = sigmaWith(parameters);
  parameters.correlated_views = 4.0;
  EXPECT_NEAR(sigmaWith(parameters), 2.0 * independent, 1e-6 * independent);
  parameters.correlated_views = 1000.0;
  EXPECT_NEAR(sigmaWith(parameters), 10.0 * independent, 1e-6 * independent)
      << "a hundred views are never less than one";
}

TEST(LineMapper, AddsItsFloorToTheSigmaOfTheTracker) {
  LineMapperParameters parameters = independentViews();
  parameters.sigma_floor = 0.0;
  const double bare = sigmaWith(parameters);
  parameters.sigma_floor = 0.4;  // beside the 0.3 px of seen()
  EXPECT_NEAR(sigmaWith(parameters), 5.0 / 3.0 * bare, 1e-4 * bare);
}

TEST(LineMapper, KeepsAFewViewsSpreadOverTheLife) {
  LineMapperParameters parameters = independentViews();
  parameters.max_views = 1000;
  const double all = sigmaWith(parameters);
  parameters.max_views = 8;
  // 4 to 8 of a hundred, and the last.
  EXPECT_GT(sigmaWith(parameters), 2.5 * all);
}

TEST(LineMapper, EndsTracksWhereANewEpochBegins) {
  LineMapper mapper(independentViews());
  const Eigen::Vector3d up(0.0, 0.5, 0.0);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d shift = i < 20 ? Eigen::Vector3d::Zero().eval() : up;
    LineFrame frame =
        frameOf(i, {seen(kStart + shift, kEnd + shift, poseAt(i), static_cast<std::uint32_t>(i) + 1)});
    frame.epoch = i < 20 ? 0 : 1;
    mapper.add(frame, poseAt(i));
  }
  const auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].views, 20);
  EXPECT_EQ(lines[1].epoch, 1U);
  EXPECT_LT((lines[1].start - kStart - up).norm(), 1e-5);
}

TEST(LineMapper, KnowsATrackerThatStartedAgainWithTheSameNumbers) {
  LineMapper mapper(independentViews());
  for (int i = 0; i < 20; ++i) {
    mapper.add(frameOf(i, {seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1)}), poseAt(i));
  }
  // Another line under the same id and epoch, too young to be the same.
  const Eigen::Vector3d up(0.0, 0.5, 0.0);
  for (int i = 20; i < 40; ++i) {
    mapper.add(frameOf(i, {seen(kStart + up, kEnd + up, poseAt(i), static_cast<std::uint32_t>(i) - 19)}),
               poseAt(i));
  }
  const auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_LT((lines[0].start - kStart).norm(), 1e-5);
  EXPECT_LT((lines[1].start - kStart - up).norm(), 1e-5);
  EXPECT_NE(lines[0].id, lines[1].id);
}

TEST(LineMapper, KeepsNoMoreThanItIsAllowedTo) {
  LineMapperParameters parameters;
  parameters.max_lines = 3;
  parameters.max_views = 8;
  LineMapper mapper(parameters);
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 100; ++i) {
      TrackedLine line = seen(kStart, kEnd, poseAt(i), static_cast<std::uint32_t>(i) + 1);
      line.id = static_cast<std::uint64_t>(k);
      mapper.add(frameOf(i, {line}), poseAt(i));
    }
    mapper.finish();
  }
  const auto lines = mapper.lines();
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].track, 2U);
  EXPECT_EQ(lines[0].views, 100);
  EXPECT_LT((lines[0].start - kStart).norm(), 1e-5);
}

TEST(LineMapper, NamesEveryBrokenRule) {
  LineMapperParameters parameters;
  parameters.min_views = 1;
  parameters.max_sigma = -1.0;
  try {
    LineMapper mapper(parameters);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("min_views"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("max_sigma"), std::string::npos);
  }
}

}  // namespace
}  // namespace tet_line_tracker
