// Tracks a sequence of generated images and prints, for each image, a hash of the image and of its lines, bit
// by bit: two processors that agree print the same (scripts/test_arm64.sh). The images are made of integers,
// so that they are equal everywhere.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

constexpr std::size_t kImages = 20;
constexpr int kWidth = 480;
constexpr int kHeight = 360;
constexpr int kFocal = 360;                   ///< [px]
constexpr std::int64_t kPeriodNs = 50000000;  ///< between two images
constexpr int kSub = 3;                       ///< samples across a pixel
/// The undistorted radius is r (1 + r^2 / kLens), r the radius in the image over the focal length.
constexpr int kLens = 10;
constexpr int kTurn = 3;  ///< of the camera to the right from one image to the next [px in the middle]

class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 1099511628211ULL;
  }
  template <typename Number>
  void add(Number number) {
    // All NaNs are one: their sign is not a result.
    if (number != number) return add("NaN", 3);
    add(&number, sizeof number);
  }
  unsigned long long value() const { return value_; }

 private:
  std::uint64_t value_{14695981039346656037ULL};
};

std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// Gray of an endless wall of boxes, one in each cell. Coordinates in 1/1024 px.
int wall(std::int64_t x, std::int64_t y) {
  constexpr std::int64_t kCell = 64 * 1024;
  const std::int64_t column = floorDivide(x, kCell), row = floorDivide(y, kCell);
  const auto seed = scramble(static_cast<std::uint32_t>(column * 7919 + row * 104729 + 1000000));
  const std::int64_t left = 4 + seed % 12, top = 4 + (seed >> 4) % 12;
  const std::int64_t right = 44 + (seed >> 8) % 16, bottom = 40 + (seed >> 12) % 20;
  const std::int64_t in_x = x - column * kCell, in_y = y - row * kCell;
  const bool inside =
      in_x >= left * 1024 && in_x < right * 1024 && in_y >= top * 1024 && in_y < bottom * 1024;
  return inside ? 20 + static_cast<int>((seed >> 20) % 210) : 115;
}

/// The wall through the lens, from a camera that turns, sinks, comes nearer and rolls a little; with noise.
cv::Mat makeImage(int index) {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  // Samples lie on a grid of 1 / (2 kSub) px.
  constexpr std::int64_t kUnit = 2 * kSub;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      int gray = 0;
      for (int k = 0; k < kSub * kSub; ++k) {
        const std::int64_t u = (2 * x - kWidth + 1) * kSub + 2 * (k % kSub) - kSub + 1;
        const std::int64_t v = (2 * y - kHeight + 1) * kSub + 2 * (k / kSub) - kSub + 1;
        constexpr std::int64_t kBase = kLens * kFocal * kFocal * kUnit * kUnit;
        const std::int64_t zoom = 2048 - 4 * index;
        const std::int64_t wide = kBase + u * u + v * v;
        const std::int64_t a = floorDivide(u * wide / (kBase >> 10) * zoom, kUnit * 2048);
        const std::int64_t b = floorDivide(v * wide / (kBase >> 10) * zoom, kUnit * 2048);
        gray += wall(a - floorDivide(b * index, 700) + 1024 * kTurn * index,
                     b + floorDivide(a * index, 700) + 700 * index);
      }
      const auto noise =
          static_cast<int>(scramble(static_cast<std::uint32_t>((index * kHeight + y) * kWidth + x)) % 7U);
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(gray / (kSub * kSub) + noise - 3);
    }
  }
  return image;
}

/// The lens of makeImage(), as a series.
CameraCalibration calibration() {
  CameraCalibration camera;
  camera.model = "plumb_bob";
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = kFocal;
  camera.cx = 0.5 * (kWidth - 1);
  camera.cy = 0.5 * (kHeight - 1);
  const double a = 1.0 / kLens;
  camera.distortion = {-a, 3.0 * a * a, 0.0, 0.0, -12.0 * a * a * a};
  return camera;
}

unsigned long long hashOf(const LineFrame& frame) {
  Hash hash;
  for (const TrackedLine& line : frame.lines) {
    hash.add(line.id);
    hash.add(line.age);
    hash.add(line.cut);
    for (const Eigen::Vector2f& point : {line.segment.start, line.segment.end}) {
      hash.add(point.x());
      hash.add(point.y());
    }
    for (const Eigen::Vector2d& point : {line.start_normalized, line.end_normalized}) {
      hash.add(point.x());
      hash.add(point.y());
    }
    hash.add(line.sigma_px);
    for (const float covariance : line.covariance_px) hash.add(covariance);
    hash.add(line.residual);
  }
  for (const float direction : frame.statistics.translation) hash.add(direction);
  hash.add(frame.statistics.prior_rotation);
  return hash.value();
}

void run(const std::string& method, const std::string& detector, bool imu,
         const std::vector<cv::Mat>& images) {
  LineTrackerParameters parameters;
  parameters.method = method;
  parameters.detection.detector = detector;
  LineTracker tracker(parameters);
  tracker.setCamera(makeCameraModel(calibration()));
  if (imu) tracker.setImuRotation(Eigen::Matrix3d::Identity());
  std::int64_t imu_stamp = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::int64_t stamp = static_cast<std::int64_t>(i + 1) * kPeriodNs;
    for (; imu && imu_stamp <= stamp + kPeriodNs / 5; imu_stamp += kPeriodNs / 10) {
      // Ten for each image, with a tremble that the images do not have.
      const double tremble = static_cast<double>(imu_stamp / 5000000 % 3 - 1) * 0.01;
      tracker.addAngularVelocity(imu_stamp,
                                 {tremble, kTurn * 1e9 / kPeriodNs / kFocal, 1e9 / kPeriodNs / 700});
    }
    const FrameResult result = tracker.process(images[i], stamp);
    Hash image;
    image.add(images[i].data, images[i].total());
    std::printf("%s %s%s image %zu %016llx lines %016llx %zu prior %s\n", method.c_str(), detector.c_str(),
                imu ? " imu" : "", i, image.value(), hashOf(*result.frame), result.frame->lines.size(),
                result.frame->statistics.prior.c_str());
  }
}

}  // namespace
}  // namespace tet_line_tracker

int main() {
  std::vector<cv::Mat> images(tet_line_tracker::kImages);
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i] = tet_line_tracker::makeImage(static_cast<int>(i));
  }
  tet_line_tracker::run("joint", "edge", false, images);
  tet_line_tracker::run("joint", "edge", true, images);
  tet_line_tracker::run("paper", "edge", false, images);
  tet_line_tracker::run("paper", "lsd", false, images);
}
