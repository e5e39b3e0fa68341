// The offset between the clocks of IMU and camera, estimated on a simulated flight.

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "simulation/simulation.h"
#include "tet_line_tracker/motion/motion_prior.h"

namespace tet_line_tracker {
namespace {

/// A prior whose IMU is late by `offset_s`, fed as the node feeds it.
class DelayedImu {
 public:
  /// `told`: the parameter imu_time_offset.
  DelayedImu(double offset_s, const std::string& told, const std::shared_ptr<const CameraModel>& camera)
      : prior_([&] {
          MotionPriorParameters parameters;
          parameters.imu_time_offset = told;
          return MotionPrior(parameters);
        }()),
        offset_s_(offset_s) {
    prior_.setCamera(camera);
    prior_.setImuRotation(defaultCameraFromImu().linear());
  }

  MotionPrediction predict(const Simulation& simulation, const ImagePyramid& pyramid, std::int64_t stamp_ns) {
    const double until_s = simulation.timeOf(stamp_ns) + prior_.imuTimeOffset();
    for (bool beyond = false; !beyond; ++sample_) {
      const double time_s = -0.3 + 0.005 * sample_;
      const InertialSample sample =
          errors_.apply(idealInertialSample(simulation.trajectory(), defaultCameraFromImu(), time_s));
      prior_.addAngularVelocity(simulation.stampAt(time_s + offset_s_), sample.angular_velocity);
      beyond = time_s + offset_s_ >= until_s;
    }
    return prior_.predict(pyramid, stamp_ns);
  }
  double offset() const { return prior_.imuTimeOffset(); }
  void setDelay(double offset_s) { offset_s_ = offset_s; }

 private:
  MotionPrior prior_;
  double offset_s_;
  int sample_{0};
  InertialErrors errors_{1, 200.0};
};

TEST(ImuTimeOffset, IsFoundToAMillisecondOnAShakenFlightAndStaysAtZeroWhereThereIsNone) {
  SimulationOptions options;
  options.motion = "shake";
  options.seconds = 8.0;
  options.threads = 2;
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  Simulation simulation(options, camera);
  DelayedImu none(0.0, "auto", camera);
  DelayedImu late(0.02, "auto", camera);
  DelayedImu early(-0.03, "auto", camera);
  for (int i = 0; i < simulation.imageCount(); ++i) {
    const std::int64_t stamp = simulation.imageStamp(i);
    ImagePyramid pyramid;
    pyramid.build(simulation.nextImage(), MotionPrior::kPyramidLevels);
    none.predict(simulation, pyramid, stamp);
    late.predict(simulation, pyramid, stamp);
    early.predict(simulation, pyramid, stamp);
    EXPECT_LT(std::abs(none.offset()), 1e-3) << i;
  }
  EXPECT_NEAR(late.offset(), 0.02, 1e-3);
  EXPECT_NEAR(early.offset(), -0.03, 1e-3);
}

/// Images of a shaken flight, from `first` on, in which the rotation is off by over 2 px; the stamps of the
/// IMU are late by 30 ms from image `late_from` on.
int wrongRotations(int late_from, int first) {
  SimulationOptions options;
  options.motion = "shake";
  options.seconds = 4.0;
  options.threads = 2;
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  Simulation simulation(options, camera);
  DelayedImu imu(0.0, "0", camera);
  const auto rotationAt = [&](int image) -> Eigen::Matrix3d {
    return simulation.trajectory().worldFromCamera(simulation.timeOf(simulation.imageStamp(image))).linear();
  };
  int wrong = 0;
  for (int i = 0; i < simulation.imageCount(); ++i) {
    if (i == late_from) imu.setDelay(0.03);
    ImagePyramid pyramid;
    pyramid.build(simulation.nextImage(), MotionPrior::kPyramidLevels);
    const MotionPrediction prediction = imu.predict(simulation, pyramid, simulation.imageStamp(i));
    if (i < first) continue;
    const Eigen::Matrix3d truth = rotationAt(i).transpose() * rotationAt(i - 1);
    constexpr double kWrong = 0.005;  // 2 px [rad]
    if (Eigen::AngleAxisd(truth.transpose() * prediction.rotation).angle() > kWrong) ++wrong;
  }
  return wrong;
}

TEST(MotionPrior, IsNotLedByAGyroscopeWhoseStampsAreLate) {
  EXPECT_LT(wrongRotations(0, 1), 16) << "of 80";
}

TEST(MotionPrior, NoticesThatAGyroscopeWhichItTrustedIsWrong) {
  EXPECT_LT(wrongRotations(30, 31), 10) << "of 50";
}

}  // namespace
}  // namespace tet_line_tracker
