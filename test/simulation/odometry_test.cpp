#include "simulation/odometry.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

Trajectory trajectoryOf(const char* motion) {
  TrajectoryOptions options;
  options.motion = motion;
  options.seed = 3;
  options.free_centre = {4.0, 3.0, 1.5};
  options.free_half_extent = {2.0, 1.5, 0.5};
  return Trajectory(options);
}

TEST(SimulatedOdometry, FollowsTheTrueWayUpToItsErrors) {
  for (const char* motion : {"slow", "drive"}) {
    const bool car = motion == std::string("drive");
    const Trajectory trajectory = trajectoryOf(motion);
    SimulatedOdometry odometry(trajectory, car, 3, 0.0);
    double worst_way = 0.0;
    for (int i = 1; i <= 500; ++i) {
      const double time_s = 0.02 * i;
      Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
      if (i > 1) before = odometry.advance(time_s - 0.02);
      const Eigen::Isometry3d step = before.inverse() * odometry.advance(time_s);
      const Eigen::Isometry3d body = defaultCameraFromBody(car);
      const Eigen::Isometry3d truth = (trajectory.worldFromCamera(time_s - 0.02) * body).inverse() *
                                      trajectory.worldFromCamera(time_s) * body;
      const double way = car ? truth.translation().x() : truth.translation().norm();
      worst_way = std::max(worst_way, std::abs(step.translation().norm() / way - 1.0));
      EXPECT_LT(Eigen::AngleAxisd(step.linear().transpose() * truth.linear()).angle(), 0.01) << time_s;
      if (car) {
        EXPECT_EQ(step.linear()(2, 2), 1.0);
        EXPECT_NEAR(step.translation().y(), 0.0, 1e-9);
      }
    }
    EXPECT_LT(worst_way, 0.06) << motion;
    EXPECT_GT(worst_way, 0.001) << motion;
  }
}

}  // namespace
}  // namespace tet_line_tracker
