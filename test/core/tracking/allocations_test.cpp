/// In steady state an image costs no memory from the heap: neither from the standard containers nor from
/// OpenCV.

#include "tet_line_tracker/tracking/line_tracker.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "synthetic_images.h"

namespace {

long allocations = 0;

}  // namespace

// The sanitizers have an allocator of their own, which is not to be replaced.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define TET_COUNTS_ALLOCATIONS

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

// Everything that asks for memory, operator new and cv::fastMalloc among them, comes through these.
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}
#endif

namespace tet_line_tracker {
namespace {

constexpr int kPeriod = 40;  // images until the motion repeats itself

std::vector<cv::Mat> images() {
  std::vector<cv::Mat> all;
  for (int i = 0; i < kPeriod; ++i) {
    const float angle = 2.0F * static_cast<float>(M_PI) * static_cast<float>(i) / kPeriod;
    all.push_back(boxesImage(640, 480, 25.0F * Eigen::Vector2f(std::cos(angle), std::sin(angle))));
  }
  return all;
}

class Allocations : public testing::TestWithParam<const char*> {};

TEST_P(Allocations, AreNoneInSteadyState) {
#ifndef TET_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations are counted with glibc and without sanitizers only";
#endif
  LineTrackerParameters parameters;
  parameters.method = GetParam();
  parameters.motion.prior = "image";
  parameters.detection.detector = "edge";  // LSD is OpenCV's, and takes memory
  // The detector runs again and again, in steady state too.
  parameters.detection.max_lines = parameters.detection.min_lines = 1000;
  LineTracker tracker(parameters);
  CameraCalibration calibration;
  calibration.model = "plumb_bob";
  calibration.width = 640;
  calibration.height = 480;
  calibration.fx = calibration.fy = 450.0;
  calibration.cx = 320.0;
  calibration.cy = 240.0;
  calibration.distortion = {-0.2, 0.05, 0.0, 0.0};
  tracker.setCamera(makeCameraModel(calibration));

  const std::vector<cv::Mat> all = images();
  std::int64_t stamp = 1000000000;
  std::size_t lines = 0;
  bool detected = false;
  const auto track = [&] {
    for (const cv::Mat& image : all) {
      const LineFrame* frame = tracker.process(image, stamp += 50000000).frame;
      lines += frame->lines.size();
      detected |= frame->detected;
    }
  };
  track();
  track();
  const long warm = allocations;
  EXPECT_GT(warm, 0);
  lines = 0;
  detected = false;
  track();
  EXPECT_EQ(allocations, warm);
  EXPECT_TRUE(detected);
  EXPECT_GT(lines, 8U * kPeriod);
}

INSTANTIATE_TEST_SUITE_P(Methods, Allocations, testing::Values("joint", "paper"));

}  // namespace
}  // namespace tet_line_tracker
