#include "depth_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {
namespace {

constexpr std::int64_t kMaxTimeApartNs = 40000000;  // more than one period at 30 Hz
// Steps beside the line at which its two sides are looked at [px]. The nearer surface must show within the
// first ones: depth cameras are off by a pixel or two at edges, and things may be thin.
constexpr std::array<double, 5> kStepsBesideLine{2.0, 3.0, 4.0, 5.0, 6.0};
constexpr std::size_t kStepsToSurface = 2;
// A larger jump from step to step is another edge, not the slope of the surface.
constexpr double kMaxJump = 0.03;  // of the depth
// Depth images mix near and far at edges, and the far may be unknown (0): such pixels float in the air.
constexpr int kNeighboursOnSurface = 3;  // of 8
constexpr double kMaxStep = 0.02;        // of the depth, between neighbours on one surface
// Something must stand clearly before a point to hide it, beyond the noise of depth cameras.
constexpr double kHiddenBy = 0.05;          // [m]
constexpr double kHiddenByRelative = 0.04;  // of the depth

/// The image with pixels set to 0 that do not lie on a surface with their neighbours.
cv::Mat withoutFloatingPixels(const cv::Mat& depth_mm) {
  cv::Mat kept = cv::Mat::zeros(depth_mm.size(), CV_16UC1);
  for (int y = 1; y + 1 < depth_mm.rows; ++y) {
    for (int x = 1; x + 1 < depth_mm.cols; ++x) {
      const int z = depth_mm.at<std::uint16_t>(y, x);
      if (z == 0) continue;
      int neighbours = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        const auto* row = depth_mm.ptr<std::uint16_t>(y + dy);
        for (int dx = -1; dx <= 1; ++dx) neighbours += std::abs(row[x + dx] - z) <= kMaxStep * z ? 1 : 0;
      }
      // The pixel itself is one of the nine.
      if (neighbours > kNeighboursOnSurface) kept.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(z);
    }
  }
  return kept;
}

}  // namespace

DepthTruth::DepthTruth(PoseTrack world_from_camera, std::shared_ptr<const CameraModel> camera)
    : world_from_camera_(std::move(world_from_camera)), camera_(std::move(camera)) {}

void DepthTruth::addDepth(std::int64_t stamp_ns, const cv::Mat& depth_mm) {
  const auto pose = world_from_camera_.at(stamp_ns);
  if (!pose) return;
  const auto place =
      std::upper_bound(images_.begin(), images_.end(), stamp_ns,
                       [](std::int64_t stamp, const DepthImage& image) { return stamp < image.stamp_ns; });
  images_.insert(place, {stamp_ns, withoutFloatingPixels(depth_mm), *pose});
}

const DepthTruth::DepthImage* DepthTruth::nearest(std::int64_t stamp_ns) const {
  const auto after =
      std::lower_bound(images_.begin(), images_.end(), stamp_ns,
                       [](const DepthImage& image, std::int64_t stamp) { return image.stamp_ns < stamp; });
  const DepthImage* best = after == images_.end() ? nullptr : &*after;
  if (after != images_.begin()) {
    const DepthImage& before = *(after - 1);
    if (best == nullptr || stamp_ns - before.stamp_ns < best->stamp_ns - stamp_ns) best = &before;
  }
  if (best == nullptr || std::abs(best->stamp_ns - stamp_ns) > kMaxTimeApartNs) return nullptr;
  return best;
}

std::optional<double> DepthTruth::depthOf(const Eigen::Isometry3d& world_from_image, const DepthImage& depth,
                                          const Eigen::Vector2d& pixel) const {
  const auto point = camera_->normalize(pixel);
  if (!point) return std::nullopt;
  const Eigen::Vector3d ray = point->homogeneous();
  const auto read = [&](const Eigen::Vector2d& at) -> double {
    const long x = std::lround(at.x());
    const long y = std::lround(at.y());
    if (x < 0 || y < 0 || x >= depth.depth_mm.cols || y >= depth.depth_mm.rows) return 0.0;
    return 1e-3 * depth.depth_mm.at<std::uint16_t>(static_cast<int>(y), static_cast<int>(x));
  };
  double z = read(pixel);
  if (z <= 0.0) return std::nullopt;
  if (world_from_image.isApprox(depth.world_from_camera, 1e-12)) return z;
  // The depth camera stood elsewhere at its own time: look where it saw the point, twice to settle.
  const Eigen::Isometry3d depth_from_image = depth.world_from_camera.inverse() * world_from_image;
  for (int pass = 0; pass < 2; ++pass) {
    const auto there = camera_->project(depth_from_image * (z * ray));
    const auto ray_there = there ? camera_->normalize(*there) : std::nullopt;
    const double z_there = there ? read(*there) : 0.0;
    if (!ray_there || z_there <= 0.0) return std::nullopt;
    z = (depth_from_image.inverse() * (z_there * ray_there->homogeneous())).z();
  }
  return z;
}

std::optional<double> DepthTruth::inverseDepthOfSide(const Eigen::Isometry3d& world_from_image,
                                                     const DepthImage& depth, const Eigen::Vector2d& pixel,
                                                     const Eigen::Vector2d& normal) const {
  std::array<double, kStepsBesideLine.size()> z{};
  std::optional<std::size_t> nearest_step;
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = depthOf(world_from_image, depth, pixel + kStepsBesideLine[i] * normal).value_or(0.0);
    if (i < kStepsToSurface && z[i] > 0.0 && (!nearest_step || z[i] < z[*nearest_step])) nearest_step = i;
  }
  if (!nearest_step) return std::nullopt;

  // On a plane the inverse depth is affine in the (undistorted) image: a straight line through the steps on
  // the nearest surface, read at the line itself.
  double n = 0.0, sum_s = 0.0, sum_w = 0.0, sum_ss = 0.0, sum_sw = 0.0;
  const auto take = [&](std::size_t i, double& last) {
    if (z[i] <= 0.0) return true;  // a hole
    if (std::abs(z[i] - last) > kMaxJump * last) return false;
    last = z[i];
    const double step = kStepsBesideLine[i];
    const double w = 1.0 / z[i];
    n += 1.0;
    sum_s += step;
    sum_w += w;
    sum_ss += step * step;
    sum_sw += step * w;
    return true;
  };
  double last = z[*nearest_step];
  for (std::size_t i = *nearest_step; i < z.size() && take(i, last); ++i) {
  }
  last = z[*nearest_step];
  for (std::size_t i = *nearest_step; i > 0 && take(i - 1, last); --i) {
  }
  const double spread = n * sum_ss - sum_s * sum_s;
  if (n < 3.0 || spread <= 0.0) return sum_w / n;
  const double slope = (n * sum_sw - sum_s * sum_w) / spread;
  return (sum_w - slope * sum_s) / n;
}

std::optional<WorldPoint> DepthTruth::lift(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                           const Eigen::Vector2d& normal) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  const DepthImage* depth = nearest(stamp_ns);
  const auto point = camera_->normalize(pixel);
  if (!pose || depth == nullptr || !point) return std::nullopt;
  const auto left = inverseDepthOfSide(*pose, *depth, pixel, normal);
  const auto right = inverseDepthOfSide(*pose, *depth, pixel, -normal);
  // Depth cameras lose the far side of an edge, so one side alone is the near one.
  double inverse_depth = std::max(left.value_or(0.0), right.value_or(0.0));
  if (inverse_depth <= 0.0) return std::nullopt;
  // Both sides on one surface: the nearer of two noisy readings would be too near.
  if (left && right && std::abs(*left - *right) < kMaxJump * inverse_depth) {
    inverse_depth = 0.5 * (*left + *right);
  }
  return WorldPoint{0, *pose * (point->homogeneous() / inverse_depth)};
}

std::optional<PointView> DepthTruth::view(const WorldPoint& point, std::int64_t stamp_ns) const {
  const auto pose = world_from_camera_.at(stamp_ns);
  if (!pose) return std::nullopt;
  const Eigen::Vector3d in_camera = pose->inverse() * point.position;
  const auto pixel = camera_->project(in_camera);
  if (!pixel) return std::nullopt;
  PointView view;
  view.pixel = *pixel;
  view.in_camera = in_camera;
  const CameraCalibration& calibration = camera_->calibration();
  view.in_picture =
      ImageBounds::ofImage(calibration.width, calibration.height).contains(pixel->cast<float>());
  const DepthImage* depth = nearest(stamp_ns);
  if (depth == nullptr) return view;
  // Hidden when all that is seen around the pixel is clearly nearer; where depth is unknown nothing is.
  double farthest = 0.0;
  for (const double x : {-2.0, 0.0, 2.0}) {
    for (const double y : {-2.0, 0.0, 2.0}) {
      farthest = std::max(farthest, depthOf(*pose, *depth, *pixel + Eigen::Vector2d(x, y)).value_or(0.0));
    }
  }
  view.hidden = farthest > 0.0 && farthest < in_camera.z() * (1.0 - kHiddenByRelative) - kHiddenBy;
  return view;
}

}  // namespace tet_line_tracker
