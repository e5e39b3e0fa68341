#include "simulation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/inertial.h"
#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

const char* const kMotions[] = {"slow", "fast", "corridor", "shake", "rotation", "still"};

Simulation makeSimulation(const std::string& motion, double seconds, bool textureless_phase = false,
                          const std::string& scene = "", bool hand_sway = false) {
  SimulationOptions options;
  options.hand_sway = hand_sway;
  options.motion = motion;
  options.seconds = seconds;
  options.scene = scene;
  options.textureless_phase = textureless_phase;
  CameraCalibration camera = defaultSimulatedCamera();
  camera.width = 64;  // no image is looked at here
  camera.height = 40;
  return Simulation(options, makeCameraModel(camera));
}

TEST(Trajectory, IntegratedIdealImuStaysWithinACentimetreAndATenthOfADegreeOverTenSeconds) {
  const Eigen::Isometry3d camera_from_imu = defaultCameraFromImu();
  std::vector<std::pair<std::string, bool>> cases{{"drive", false}};
  for (const char* motion : kMotions) {
    for (const bool textureless_phase : {false, true}) cases.emplace_back(motion, textureless_phase);
  }
  for (const auto& [motion, textureless_phase] : cases) {
    const Simulation simulation = makeSimulation(motion, 10.0, textureless_phase);
    const Trajectory& trajectory = simulation.trajectory();
    const auto imuPose = [&](double t) { return trajectory.worldFromCamera(t) * camera_from_imu; };
    constexpr double kPeriod = 1.0 / 200.0;
    constexpr double kStep = 1e-4;
    Eigen::Isometry3d pose = imuPose(0.0);
    Eigen::Vector3d velocity = (imuPose(kStep).translation() - imuPose(-kStep).translation()) / (2.0 * kStep);
    for (int i = 0; i < 2000; ++i) {
      const auto sample = [&](int k) {
        return idealInertialSample(trajectory, camera_from_imu, k * kPeriod);
      };
      const InertialSample a = sample(i);
      const InertialSample b = sample(i + 1);
      // Cubic through four samples and the coning term: by trapezoids a shaken IMU would end 4 cm away.
      const Eigen::Vector3d sum = 13.0 * (a.angular_velocity + b.angular_velocity) -
                                  sample(i - 1).angular_velocity - sample(i + 2).angular_velocity;
      const Eigen::Vector3d turn =
          kPeriod / 24.0 * sum + kPeriod * kPeriod / 12.0 * a.angular_velocity.cross(b.angular_velocity);
      const Eigen::Matrix3d start = pose.linear();
      if (turn.norm() > 0.0) pose.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
      const Eigen::Vector3d gravity(0.0, 0.0, -kGravity);
      const Eigen::Vector3d first = start * a.acceleration + gravity;
      const Eigen::Vector3d second = pose.linear() * b.acceleration + gravity;
      pose.translation() += kPeriod * velocity + kPeriod * kPeriod * (first / 3.0 + second / 6.0);
      velocity += 0.5 * kPeriod * (first + second);
    }
    const Eigen::Isometry3d error = imuPose(10.0).inverse() * pose;
    EXPECT_LT(error.translation().norm(), 0.01) << motion << " " << textureless_phase;
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle() * 180.0 / M_PI, 0.1) << motion;
  }
}

TEST(Trajectory, FastRotationPeaksAtThirtyToFortyPixelsPerImage) {
  const Simulation simulation = makeSimulation("fast", 20.0);
  double fastest = 0.0;  // [px] in the middle of the image
  for (int i = 1; i < simulation.imageCount(); ++i) {
    const Eigen::Matrix3d turn =
        simulation.trajectory().worldFromCamera((i - 1) / 20.0).linear().transpose() *
        simulation.trajectory().worldFromCamera(i / 20.0).linear();
    const Eigen::Vector3d axis = turn.col(2);
    fastest = std::max(fastest, 458.0 * axis.head<2>().norm() / axis.z());
  }
  EXPECT_GT(fastest, 30.0);
  EXPECT_LT(fastest, 40.0);
}

TEST(Trajectory, KeepsAwayFromEverySurface) {
  for (const char* motion : kMotions) {
    for (const char* scene : {"room", "corridor", "empty"}) {
      if (std::string(motion) == "corridor" && std::string(scene) != "corridor") continue;
      const Simulation simulation = makeSimulation(motion, 20.0, true, scene);
      double nearest = 100.0;
      for (double t = 0.0; t <= 20.0; t += 0.25) {
        const Eigen::Vector3d position = simulation.trajectory().worldFromCamera(t).translation();
        for (int direction = 0; direction < 27; ++direction) {
          const Eigen::Vector3d ray(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
          if (ray.isZero()) continue;
          const auto hit = simulation.geometry().raycast(position, ray.normalized(), simulation.stampAt(t));
          ASSERT_TRUE(hit) << "the world has a hole: " << motion << " in " << scene << " at " << t;
          nearest = std::min(nearest, hit->distance);
        }
      }
      EXPECT_GT(nearest, 0.3) << motion << " in " << scene;
    }
  }
}

double rmsAcceleration(const Trajectory& trajectory) {
  const auto position = [&](double t) -> Eigen::Vector3d {
    return trajectory.worldFromCamera(t).translation();
  };
  constexpr double kStep = 1e-3;  // [s]
  double sum = 0.0;
  int count = 0;
  for (double t = 0.0; t < 20.0; t += 0.01, ++count) {
    sum += ((position(t + kStep) - 2.0 * position(t) + position(t - kStep)) / (kStep * kStep)).squaredNorm();
  }
  return std::sqrt(sum / count);
}

TEST(Trajectory, HandSwayAcceleratesByAboutOneMetrePerSecondSquaredWhereFlightsHardlyDo) {
  for (const char* motion : {"slow", "corridor"}) {
    EXPECT_LT(rmsAcceleration(makeSimulation(motion, 20.0).trajectory()), 0.5) << motion;
    const double swaying = rmsAcceleration(makeSimulation(motion, 20.0, false, "", true).trajectory());
    EXPECT_GT(swaying, 0.8) << motion;
    EXPECT_LT(swaying, 1.3) << motion;
  }
}

TEST(Trajectory, HandSwayStaysWithinTheWaysOfTheMotion) {
  for (const char* motion : {"slow", "fast", "corridor"}) {
    const Simulation simulation = makeSimulation(motion, 20.0, false, "", true);
    const World& world = simulation.world();
    const bool walks = std::string(motion) == "corridor";
    for (double t = 0.0; t <= 20.0; t += 0.05) {
      const Eigen::Isometry3d pose = simulation.trajectory().worldFromCamera(t);
      const Eigen::Vector3d away = (pose.translation() - world.free_centre).cwiseAbs();
      for (int axis = walks ? 1 : 0; axis < 3; ++axis) {
        ASSERT_LE(away(axis), world.free_half_extent(axis) + 1e-9) << motion << " at " << t;
      }
    }
  }
}

TEST(Trajectory, NamesTheUnknownMotion) {
  EXPECT_THROW(makeSimulation("sideways", 1.0), std::invalid_argument);
  EXPECT_THROW(makeSimulation("corridor", 1.0, false, "room"), std::invalid_argument);
  EXPECT_THROW(makeSimulation("slow", 0.0), std::invalid_argument);
  EXPECT_THROW(makeSimulation("slow", 1.0, false, "cellar"), std::invalid_argument);
}

TEST(InertialErrors, AreAsLargeAsTheSensorsNoiseAndRepeatWithTheSeed) {
  const InertialSample ideal{Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0.0, 0.0, kGravity)};
  InertialErrors errors(7, 200.0);
  InertialErrors again(7, 200.0);
  double jitter = 0.0;  // between samples in a row: noise without bias
  InertialSample last = errors.apply(ideal);
  again.apply(ideal);
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const InertialSample sample = errors.apply(ideal);
    EXPECT_EQ(sample.acceleration, again.apply(ideal).acceleration);
    jitter += (sample.angular_velocity - last.angular_velocity).squaredNorm() / 6.0;
    last = sample;
  }
  EXPECT_NEAR(1.7e-4 * std::sqrt(200.0), std::sqrt(jitter / kSamples), 2e-4);
  EXPECT_LT((last.acceleration - ideal.acceleration).norm(), 1.0);
}

}  // namespace
}  // namespace tet_line_tracker
