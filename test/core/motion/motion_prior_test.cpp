#include "tet_line_tracker/motion/motion_prior.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 752;
constexpr int kHeight = 480;
constexpr std::int64_t kMs = 1000000;
constexpr std::int64_t kPeriod = 50 * kMs;
constexpr double kDegree = M_PI / 180.0;
const Eigen::Vector2d kUnknown = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

/// A lens as EuRoC's.
std::shared_ptr<const CameraModel> camera() {
  CameraCalibration calibration;
  calibration.model = "plumb_bob";
  calibration.width = kWidth;
  calibration.height = kHeight;
  calibration.fx = 458.0;
  calibration.fy = 457.0;
  calibration.cx = 367.0;
  calibration.cy = 248.0;
  calibration.distortion = {-0.283, 0.074, 0.0002, 0.00002, 0.0};
  return makeCameraModel(calibration);
}

/// Gray value of a far world, smooth enough for the coarsest level of the pyramid.
double farGray(const Eigen::Vector3d& direction) {
  const double x = 450.0 * direction.x() / direction.z();
  const double y = 450.0 * direction.y() / direction.z();
  return 128.0 + 30.0 * std::sin(0.05 * x + 0.02 * y) + 30.0 * std::sin(0.045 * y - 0.015 * x + 1.0) +
         20.0 * std::sin(0.09 * x - 0.04 * y + 2.0) + 20.0 * std::sin(0.03 * x + 0.085 * y);
}

/// The far world seen by the camera whose directions turned by `rotation` since it looked straight ahead.
ImagePyramid view(const Eigen::Matrix3d& rotation) {
  static const std::shared_ptr<const CameraModel> lens = camera();
  cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(128));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::optional<Eigen::Vector3d> ray = lens->unproject(Eigen::Vector2d(x, y));
      if (!ray) continue;
      image.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::lround(farGray(rotation.transpose() * *ray)));
    }
  }
  ImagePyramid pyramid;
  pyramid.build(image, MotionPrior::kPyramidLevels);
  return pyramid;
}

Eigen::Matrix3d turned(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d turn = kDegree * degrees;
  if (turn.norm() == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

double degreesBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle() / kDegree;
}

MotionPriorParameters prior(const std::string& name) {
  MotionPriorParameters parameters;
  parameters.prior = name;
  return parameters;
}

/// Pose of the IMU in the camera that is neither of the two's axes.
const Eigen::Matrix3d kCameraFromImu = turned({20.0, -70.0, 110.0});

/// Samples of a gyroscope, one every 5 ms, while directions in the camera turn by `degrees` in each period.
void addGyro(MotionPrior& prior, std::int64_t first_ms, std::int64_t last_ms,
             const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d velocity = -20.0 * kDegree * (kCameraFromImu.transpose() * degrees);
  for (std::int64_t t = first_ms; t <= last_ms; t += 5) prior.addAngularVelocity(t * kMs, velocity);
}

const Eigen::Vector3d kFastTurns[] = {
    {0.0, 3.0, 0.0}, {2.5, -2.0, 0.0}, {0.0, 0.0, 4.0}, {-1.0, 2.5, -3.0}, {0.3, 0.2, -0.3}};

TEST(MotionPrior, NeedsNothingOfAPyramidOnceTheNextOneIsBuiltInItsPlace) {
  MotionPriorParameters parameters = prior("image");
  parameters.ego_motion = false;  // corners would find the turn too
  MotionPrior motion(parameters);
  motion.setCamera(camera());
  const Eigen::Matrix3d turn = turned({0.0, 2.0, 0.0});
  ImagePyramid pyramid = view(Eigen::Matrix3d::Identity());
  motion.predict(pyramid, kPeriod);
  pyramid.build(view(turn).level(0), MotionPrior::kPyramidLevels);
  EXPECT_LT(degreesBetween(motion.predict(pyramid, 2 * kPeriod).rotation, turn), 0.1);
}

TEST(MotionPrior, FindsATurnInTheImagesToATenthOfADegree) {
  for (const Eigen::Vector3d& degrees : kFastTurns) {
    MotionPrior images(prior("image"));
    images.setCamera(camera());
    EXPECT_STREQ(images.predict(view(turned({0, 0, 0})), 0).sourceName(), "none");
    const MotionPrediction prediction = images.predict(view(turned(degrees)), kPeriod);
    EXPECT_STREQ(prediction.sourceName(), "image") << degrees.transpose();
    EXPECT_LT(degreesBetween(prediction.rotation, turned(degrees)), 0.1) << degrees.transpose();
    EXPECT_NEAR(prediction.angle() / kDegree, degrees.norm(), 0.1);
  }
}

TEST(MotionPrior, PredictsWhereAFarLineWillBe) {
  const Eigen::Matrix3d rotation = turned({-1.0, 2.5, -3.0});
  MotionPrior images(prior("image"));
  images.setCamera(camera());
  images.predict(view(turned({0, 0, 0})), 0);
  const MotionPrediction prediction = images.predict(view(rotation), kPeriod);
  const LineSegment line{{200.0F, 150.0F}, {450.0F, 300.0F}};
  const LineSegment expected = images.apply(prediction, line, kUnknown, kUnknown);
  const auto truth = [&](const Eigen::Vector2f& point) {
    return *camera()->project(rotation * *camera()->unproject(point.cast<double>()));
  };
  EXPECT_LT((expected.start.cast<double>() - truth(line.start)).norm(), 1.0);
  EXPECT_LT((expected.end.cast<double>() - truth(line.end)).norm(), 1.0);
  EXPECT_GT((expected.start - line.start).norm(), 15.0F);
}

TEST(MotionPrior, AssumesAPinholeWithoutCalibration) {
  const Eigen::Matrix3d rotation = turned({1.5, -2.0, 0.0});
  MotionPrior images(prior("auto"));
  images.predict(view(turned({0, 0, 0})), 0);
  const MotionPrediction prediction = images.predict(view(rotation), kPeriod);
  EXPECT_STREQ(prediction.sourceName(), "image");
  const LineSegment line{{300.0F, 200.0F}, {450.0F, 300.0F}};
  const LineSegment expected = images.apply(prediction, line, kUnknown, kUnknown);
  for (const auto& [from, to] : {std::pair{line.start, expected.start}, {line.end, expected.end}}) {
    const Eigen::Vector2d truth = *camera()->project(rotation * *camera()->unproject(from.cast<double>()));
    EXPECT_LT((to.cast<double>() - truth).norm(), 3.0);
    EXPECT_GT((from.cast<double>() - truth).norm(), 15.0);
  }
}

TEST(MotionPrior, TakesTheImuWhereItIsRight) {
  for (const char* name : {"imu", "auto"}) {
    for (const Eigen::Vector3d& degrees : kFastTurns) {
      MotionPrior both(prior(name));
      both.setCamera(camera());
      both.setImuRotation(kCameraFromImu);
      addGyro(both, -5, 55, degrees);
      both.predict(view(turned({0, 0, 0})), 0);
      const MotionPrediction prediction = both.predict(view(turned(degrees)), kPeriod);
      EXPECT_STREQ(prediction.sourceName(), "imu") << name << ", " << degrees.transpose();
      EXPECT_LT(degreesBetween(prediction.rotation, turned(degrees)), 0.1);
    }
  }
}

TEST(MotionPrior, TakesTheImuAtItsOwnStampsOfBothImages) {
  const Eigen::Vector3d degrees(2.5, -2.0, 0.0);
  for (const std::int64_t offset_ms : {20, -20}) {
    // Samples around the images by the clock of the IMU, in which the camera turns between them alone.
    for (const bool told : {true, false}) {
      MotionPriorParameters parameters = prior("imu");
      parameters.imu_time_offset = told ? std::to_string(1e-3 * static_cast<double>(offset_ms)) : "0";
      MotionPrior shifted(parameters);
      shifted.setCamera(camera());
      shifted.setImuRotation(kCameraFromImu);
      addGyro(shifted, offset_ms - 1, offset_ms + 54, degrees);
      shifted.predict(view(turned({0, 0, 0})), 0);
      const MotionPrediction prediction = shifted.predict(view(turned(degrees)), kPeriod);
      EXPECT_STREQ(prediction.sourceName(), told ? "imu" : "image") << offset_ms;
      EXPECT_EQ(shifted.imuTimeOffset(), told ? 1e-3 * static_cast<double>(offset_ms) : 0.0);
    }
  }
}

TEST(MotionPrior, AWrongImuIsRefusedAndNeverWorseThanNone) {
  for (const char* name : {"imu", "auto"}) {
    for (const Eigen::Vector3d& degrees : kFastTurns) {
      MotionPrior both(prior(name));
      both.setCamera(camera());
      both.setImuRotation(kCameraFromImu);
      addGyro(both, -5, 55, Eigen::Vector3d(-degrees));  // as with an extrinsic turned by half a turn
      both.predict(view(turned({0, 0, 0})), 0);
      const MotionPrediction prediction = both.predict(view(turned(degrees)), kPeriod);
      EXPECT_STRNE(prediction.sourceName(), "imu") << degrees.transpose();
      const double without = degrees.norm();
      const double with = degreesBetween(prediction.rotation, turned(degrees));
      if (std::string(name) == "imu") {
        EXPECT_LE(with, without + 1e-6);
      } else {
        EXPECT_LT(with, 0.1);
      }
    }
  }
}

TEST(MotionPrior, TheGyroscopeLeadsWhereTheImagesAloneGoAstray) {
  for (const Eigen::Vector3d& degrees :
       {Eigen::Vector3d(0.0, 12.0, 0.0), Eigen::Vector3d(0.0, 8.0, 0.0), Eigen::Vector3d(7.0, 7.0, 0.0)}) {
    for (const char* name : {"image", "imu", "auto"}) {
      MotionPriorParameters parameters = prior(name);
      parameters.ego_motion = false;  // which finds such turns by corners
      MotionPrior both(parameters);
      both.setCamera(camera());
      both.setImuRotation(kCameraFromImu);
      addGyro(both, -5, 55, degrees);
      both.predict(view(turned({0, 0, 0})), 0);
      const MotionPrediction prediction = both.predict(view(turned(degrees)), kPeriod);
      const double error = degreesBetween(prediction.rotation, turned(degrees));
      if (std::string(name) == "image") {
        EXPECT_GT(error, 2.0) << degrees.transpose();
      } else {
        EXPECT_STREQ(prediction.sourceName(), "imu");
        EXPECT_LT(error, 1.0) << name << ", " << degrees.transpose();
      }
    }
  }
}

TEST(MotionPrior, LearnsABiasOfAFifthOfARadianPerSecondAtAnyRate) {
  const Eigen::Vector3d bias(0.12, -0.16, 0.02);  // in the camera [rad/s]
  for (const std::int64_t period_ms : {50, 5}) {
    // The camera turns to and fro at 30 degrees per second.
    const Eigen::Vector3d step(0.0, 0.03 * static_cast<double>(period_ms), 0.0);
    const ImagePyramid views[] = {view(turned({0, 0, 0})), view(turned(step))};
    for (const char* name : {"imu", "auto"}) {
      MotionPrior both(prior(name));
      both.setCamera(camera());
      both.setImuRotation(kCameraFromImu);
      for (std::int64_t k = 0; k <= 12; ++k) {
        const Eigen::Vector3d velocity =
            (k % 2 == 1 ? -1.0 : 1.0) * kDegree * step / (1e-3 * static_cast<double>(period_ms));
        // Two samples in each period, so that none is interpolated across the turning point.
        const std::int64_t end = k * period_ms * kMs;
        const Eigen::Vector3d measured = kCameraFromImu.transpose() * (velocity + bias);
        both.addAngularVelocity(end - period_ms * kMs + 1, measured);
        both.addAngularVelocity(end, measured);
        both.predict(views[k % 2], end);
      }
      EXPECT_LT((both.gyroBias() - bias).norm(), 0.02) << name << ", " << period_ms << " ms";
      both.setImuRotation(turned({10.0, 0.0, 0.0}));
      EXPECT_EQ(both.gyroBias(), Eigen::Vector3d(0.0, 0.0, 0.0)) << "another IMU has another bias";
    }
  }
}

TEST(MotionPrior, AGyroscopeIsTakenOnTrustUntilTheImagesShowNothingForAWhile) {
  MotionPrior both(prior("imu"));
  both.setCamera(camera());
  both.setImuRotation(kCameraFromImu);
  const ImagePyramid standing = view(turned({0, 0, 0}));
  std::int64_t stamp = 0;
  const auto see = [&](const ImagePyramid& pyramid, double rad_per_s) {
    const Eigen::Vector3d velocity(0.0, 0.0, rad_per_s);
    both.addAngularVelocity(stamp + 1, velocity);
    stamp += kPeriod;
    both.addAngularVelocity(stamp, velocity);
    return both.predict(pyramid, stamp);
  };
  for (int image = 0; image < 20; ++image) see(standing, 0.0);
  // A turn that the images do not confirm, as they show something else each time, is the gyroscope's word
  // alone.
  const auto seeAnother = [&](int image) {
    return see(view(turned({20.0 * image, 37.0 * image, 0.0})), 0.4);
  };
  const MotionPrediction first = seeAnother(1);
  EXPECT_STREQ(first.sourceName(), "imu");
  EXPECT_NEAR(first.angle(), 0.02, 0.004);
  for (int image = 2; image < 10; ++image) seeAnother(image % 2 == 0 ? 0 : 1);
  EXPECT_STREQ(seeAnother(0).sourceName(), "none");
}

TEST(MotionPrior, AStandingCameraIsNotTurnedByAWrongImu) {
  MotionPrior both(prior("auto"));
  both.setCamera(camera());
  both.setImuRotation(kCameraFromImu);
  addGyro(both, -5, 55, {0.0, 3.0, 0.0});
  both.predict(view(turned({0, 0, 0})), 0);
  EXPECT_LT(both.predict(view(turned({0, 0, 0})), kPeriod).angle(), 0.02 * kDegree);
}

TEST(MotionPrior, TheImageStandsInWhereImuSamplesOrTheExtrinsicAreMissing) {
  const Eigen::Vector3d degrees(2.5, -2.0, 0.0);
  for (const char* name : {"imu", "auto"}) {
    MotionPrior late(prior(name));
    late.setCamera(camera());
    late.setImuRotation(kCameraFromImu);
    addGyro(late, -5, 45, degrees);  // the last one is before the image
    late.predict(view(turned({0, 0, 0})), 0);
    EXPECT_STREQ(late.predict(view(turned(degrees)), kPeriod).sourceName(), "image");

    MotionPrior without(prior(name));
    without.setCamera(camera());
    addGyro(without, -5, 55, degrees);
    without.predict(view(turned({0, 0, 0})), 0);
    EXPECT_STREQ(without.predict(view(turned(degrees)), kPeriod).sourceName(), "image");
  }
}

TEST(MotionPrior, NeitherNoneNorTheFirstImageAfterAResetPredictsMotion) {
  MotionPrior none(prior("none"));
  none.predict(view(turned({0, 0, 0})), 0);
  EXPECT_EQ(none.predict(view(turned({0, 3, 0})), kPeriod).angle(), 0.0);

  MotionPrior images(prior("image"));
  images.setCamera(camera());
  images.predict(view(turned({0, 0, 0})), 0);
  images.reset();
  EXPECT_EQ(images.predict(view(turned({0, 3, 0})), kPeriod).angle(), 0.0);
}

TEST(MotionPrior, AfterAWhileABiasedGyroscopeAgreesWithTheImages) {
  // A sway of 4 degrees to both sides, eight images long; known at every moment.
  const Eigen::Vector3d sway(2.4, -3.2, 0.0);  // [degrees]
  const auto swayAt = [&](double images) { return Eigen::Vector3d(std::sin(M_PI / 4.0 * images) * sway); };
  const Eigen::Vector3d bias = kCameraFromImu.transpose() * Eigen::Vector3d(0.05, 0.03, -0.05);  // [rad/s]
  const double period_s = 1e-9 * static_cast<double>(kPeriod);
  std::vector<ImagePyramid> views;
  for (int k = 0; k < 8; ++k) views.push_back(view(turned(swayAt(k))));

  MotionPrior imu(prior("imu"));
  imu.setCamera(camera());
  imu.setImuRotation(kCameraFromImu);
  constexpr int kImages = 160;  // 8 s
  for (int k = 0; k < kImages; ++k) {
    for (int ms = k == 0 ? -5 : 5; ms <= 50; ms += 5) {
      const double images = static_cast<double>(k - 1) + ms / 50.0;
      const double rate = M_PI / 4.0 * std::cos(M_PI / 4.0 * images) / period_s;
      const Eigen::Vector3d velocity = -rate * kDegree * (kCameraFromImu.transpose() * sway);
      imu.addAngularVelocity((k - 1) * kPeriod + ms * kMs, velocity + bias);
    }
    const MotionPrediction prediction = imu.predict(views[static_cast<std::size_t>(k % 8)], k * kPeriod);
    if (k < kImages - 8) continue;
    const Eigen::Matrix3d truth = turned(swayAt(k)) * turned(swayAt(k - 1)).transpose();
    EXPECT_STREQ(prediction.sourceName(), "imu") << k;
    // The bias turns by 0.22 degrees from image to image.
    EXPECT_LT(degreesBetween(prediction.rotation, truth), 0.07) << k;
  }
}

}  // namespace
}  // namespace tet_line_tracker
