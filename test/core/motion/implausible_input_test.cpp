#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "camera/camera_models.h"
#include "synthetic_images.h"
#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 400;
constexpr std::int64_t kMs = 1000000;
constexpr std::int64_t kStart = 1000000000000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

CameraCalibration calibrationOf(const char* model, double focal, std::vector<double> distortion) {
  CameraCalibration c;
  c.model = model;
  c.width = kWidth;
  c.height = kHeight;
  c.fx = c.fy = focal;
  c.cx = 319.5;
  c.cy = 199.5;
  c.distortion = std::move(distortion);
  return c;
}

/// A model of someone else's that answers everything with the same number.
class ConstantModel final : public CameraModel {
 public:
  explicit ConstantModel(double value) : CameraModel(calibrationOf("", 400.0, {})), value_(value) {}
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d&) const override {
    return Eigen::Vector2d(value_, -value_);
  }
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    return Eigen::Vector3d((pixel.x() - 319.5) / 400.0, (pixel.y() - 199.5) / 400.0, 1.0).normalized();
  }

 private:
  double value_;
};

/// Projects as a pinhole, but every other line of pixels to `value`: the model is not smooth.
class TornModel final : public CameraModel {
 public:
  explicit TornModel(double value) : CameraModel(calibrationOf("", 400.0, {})), value_(value) {}
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    const Eigen::Vector2d pixel(400.0 * point.x() / point.z() + 319.5, 400.0 * point.y() / point.z() + 199.5);
    if (std::fmod(std::abs(pixel.x()), 2.0) < 1.0) return pixel;
    return Eigen::Vector2d(pixel.x(), value_);
  }
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    return Eigen::Vector3d((pixel.x() - 319.5) / 400.0, (pixel.y() - 199.5) / 400.0, 1.0).normalized();
  }

 private:
  double value_;
};

LineTrackerParameters parametersOf(const std::string& method, const std::string& prior) {
  LineTrackerParameters parameters;
  parameters.method = method;
  parameters.motion.prior = prior;
  return parameters;
}

/// A few images, the camera moving to the right; every line that comes out must keep the promises of a line.
/// Returns the number of lines in the last image.
std::size_t track(LineTracker& tracker) {
  std::size_t lines = 0;
  for (int k = 0; k < 5; ++k) {
    const cv::Mat image = boxesImage(kWidth, kHeight, {-3.0F * static_cast<float>(k), 0.0F});
    const LineFrame* frame = tracker.process(image, kStart + k * 50 * kMs).frame;
    EXPECT_NE(frame, nullptr);
    if (frame == nullptr) return 0;
    lines = frame->lines.size();
    for (const TrackedLine& line : frame->lines) {
      for (const Eigen::Vector2f& point : {line.segment.start, line.segment.end}) {
        EXPECT_TRUE(ImageBounds::ofImage(kWidth, kHeight).contains(point)) << point.transpose();
      }
      EXPECT_GE(line.segment.length(), 30.0F);
      EXPECT_TRUE(line.start_normalized.allFinite() && line.end_normalized.allFinite());
    }
  }
  return lines;
}

TEST(ImplausibleInput, ACalibrationThatIsRefusedAtTheDoorBreaksNothingInside) {
  const std::vector<double> typed{458.654, 457.296, 367.215, 248.375};
  const std::vector<std::pair<const char*, CameraCalibration>> calibrations = {
      {"intrinsics as plumb_bob", calibrationOf("plumb_bob", 458.0, typed)},
      {"hundreds", calibrationOf("plumb_bob", 458.0, {100, 100, 100, 100})},
      {"fx of 1e6", calibrationOf("plumb_bob", 1e6, {-0.28, 0.07, 0, 0})},
      {"fx of 1e7", calibrationOf("plumb_bob", 1e7, {-0.28, 0.07, 0, 0})},
      {"fx of 1e300", calibrationOf("plumb_bob", 1e300, {})},
      {"fx of 1e-300", calibrationOf("plumb_bob", 1e-300, {})},
      {"intrinsics as rational_polynomial",
       calibrationOf("rational_polynomial", 458.0, {458, 457, 367, 248, 458, 457, 367, 248})},
      {"intrinsics as mei", calibrationOf("mei", 458.0, {458, 457, 367, 248, 0})},
      {"intrinsics after xi of mei", calibrationOf("mei", 458.0, {1, 458, 457, 367, 248})},
      {"intrinsics as equidistant", calibrationOf("equidistant", 458.0, typed)},
      {"equidistant with 1e30", calibrationOf("equidistant", 458.0, {1e30, 1e30, 1e30, 1e30})},
      {"equidistant with -1e30", calibrationOf("equidistant", 458.0, {-1e30, 1e30, -1e30, 1e30})},
  };
  for (const auto& [name, calibration] : calibrations) {
    EXPECT_FALSE(check(calibration).empty()) << name;
    for (const char* method : {"joint", "paper"}) {
      SCOPED_TRACE(std::string(name) + ", " + method);
      LineTracker tracker(parametersOf(method, "image"));
      tracker.setCamera(makeUncheckedCameraModel(calibration));
      track(tracker);
    }
  }
}

TEST(ImplausibleInput, AModelThatProjectsToNowhereCostsThePredictionAndNoLine) {
  for (const double value : {kNan, kInfinity, 1e30, 1e300, 1e6, -1e30}) {
    for (const char* method : {"joint", "paper"}) {
      SCOPED_TRACE(std::to_string(value) + ", " + method);
      LineTracker constant(parametersOf(method, "image"));
      constant.setCamera(std::make_shared<ConstantModel>(value));
      EXPECT_GE(track(constant), 8U);
      LineTracker torn(parametersOf(method, "image"));
      torn.setCamera(std::make_shared<TornModel>(value));
      track(torn);
    }
  }
}

TEST(ImplausibleInput, NoModelBendsALineFarOutOfTheImage) {
  cv::RNG random(7);
  const auto somewhere = [&] {
    return Eigen::Vector2f(random.uniform(0.0F, 639.0F), random.uniform(0.0F, 399.0F));
  };
  for (const double value : {kNan, kInfinity, 1e30, 1e300, 1e6, -1e30, 200.0}) {
    const LensBend lens(std::make_shared<TornModel>(value), kWidth, kHeight);
    for (int i = 0; i < 2000; ++i) {
      const LineSegment chord{somewhere(), somewhere()};
      const LineBend bend = lens.between(chord);
      for (float fraction = 0.0F; fraction <= 1.0F; fraction += 1.0F / 64.0F) {
        ASSERT_LT(std::abs(bend.offset(fraction)), 1e5F) << value << ", line " << i;
      }
    }
  }
}

TEST(ImplausibleInput, OneAbsurdImuMessageIsIgnored) {
  const std::pair<const char*, Eigen::Vector3d> messages[] = {
      {"1e300 in one component", {1e300, 0.0, 0.0}},
      {"1e160 in all", {1e160, 1e160, 1e160}},
      {"-1e300", {0.0, -1e300, 0.0}},
      {"the largest double", Eigen::Vector3d::Constant(std::numeric_limits<double>::max())},
      {"NaN", {0.0, kNan, 0.0}},
      {"infinity", {kInfinity, 0.0, 0.0}},
      {"1e30", {0.0, 0.0, 1e30}},
      {"2000 rad/s", {0.0, 2000.0, 0.0}},
  };
  const auto linesWith = [](const char* prior, const Eigen::Vector3d& velocity) {
    LineTracker tracker(parametersOf("joint", prior));
    tracker.setCamera(makeCameraModel(calibrationOf("plumb_bob", 458.0, {})));
    tracker.setImuRotation(Eigen::Matrix3d::Identity());
    for (int t = -10; t <= 260; t += 5) {
      tracker.addAngularVelocity(kStart + t * kMs,
                                 t == 65 ? velocity : Eigen::Vector3d(0.0, 3.0 / 458.0 / 0.05, 0.0));
    }
    return track(tracker);
  };
  for (const char* prior : {"imu", "auto"}) {
    const std::size_t without = linesWith(prior, {0.0, 3.0 / 458.0 / 0.05, 0.0});
    EXPECT_GE(without, 8U);
    for (const auto& [name, velocity] : messages) {
      EXPECT_EQ(linesWith(prior, velocity), without) << prior << ", " << name;
    }
  }
}

}  // namespace
}  // namespace tet_line_tracker
