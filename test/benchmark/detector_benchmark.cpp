// Line detectors on the same images: a table of what they find, then their times (Google Benchmark).
//   detector_benchmark IMAGE_DIRECTORY [--benchmark_...]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#ifdef TET_HAVE_XIMGPROC
#include <opencv2/ximgproc.hpp>
#endif

#include "tet_line_tracker/line_detector.h"

namespace {

using tet_line_tracker::ImageBounds;
using tet_line_tracker::LineDetector;
using tet_line_tracker::LineSegment;

constexpr float kMinLength = 30.0F;  // [px]
constexpr int kImages = 10;
constexpr int kMotionsPerImage = 3;

cv::Mat withNoise(const cv::Mat& image, double gain, double sigma, cv::RNG& random) {
  cv::Mat noise(image.size(), CV_32FC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  cv::Mat sum;
  image.convertTo(sum, CV_32F, gain);
  sum += noise;
  cv::Mat noisy;
  sum.convertTo(noisy, CV_8U);
  return noisy;
}

cv::Matx23d randomMotion(cv::Size size, cv::RNG& random) {
  const cv::Point2f centre(static_cast<float>(size.width) / 2.0F, static_cast<float>(size.height) / 2.0F);
  cv::Mat motion = cv::getRotationMatrix2D(centre, random.uniform(-5.0, 5.0), random.uniform(0.92, 1.08));
  motion.at<double>(0, 2) += random.uniform(-10.0, 10.0);
  motion.at<double>(1, 2) += random.uniform(-10.0, 10.0);
  return motion;
}

Eigen::Vector2f moved(const cv::Matx23d& m, const Eigen::Vector2f& p) {
  return {static_cast<float>(m(0, 0) * p.x() + m(0, 1) * p.y() + m(0, 2)),
          static_cast<float>(m(1, 0) * p.x() + m(1, 1) * p.y() + m(1, 2))};
}

/// Whether `found` is the line `expected`: within 3 degrees, half of the shorter beside the longer, and there
/// both ends within 2 px of it.
bool sameLine(const LineSegment& expected, const LineSegment& found) {
  constexpr float kMaxAngle = 3.0F * static_cast<float>(CV_PI) / 180.0F;
  if (angleBetween(expected, found) > kMaxAngle) return false;
  const bool found_longer = found.length() > expected.length();
  const LineSegment& longer = found_longer ? found : expected;
  const LineSegment& shorter = found_longer ? expected : found;
  if (overlap(shorter, longer) < 0.5F) return false;
  return std::abs(longer.distance(shorter.start)) < 2.0F && std::abs(longer.distance(shorter.end)) < 2.0F;
}

struct Quality {
  double lines{0}, length{0};       // per image; mean [px]
  double expected{0}, repeated{0};  // lines that should be, and are, found again after a motion
  double dim_lines{0};              // per image at mean gray 15
  double false_lines{0};            // per image of noise, from 20 px on
};

Quality qualityOf(LineDetector& detector, const std::vector<cv::Mat>& images) {
  Quality quality;
  const double count = static_cast<double>(images.size());
  std::vector<LineSegment> lines, after;
  cv::RNG random(5);
  for (const cv::Mat& image : images) {
    detector.detect(image, kMinLength, lines);
    quality.lines += static_cast<double>(lines.size()) / count;
    for (const LineSegment& line : lines) quality.length += line.length();

    for (int k = 0; k < kMotionsPerImage; ++k) {
      const cv::Matx23d motion = randomMotion(image.size(), random);
      cv::Mat image_after;
      cv::warpAffine(image, image_after, motion, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
      detector.detect(withNoise(image, 1.0, 1.0, random), kMinLength, lines);
      // Shorter ones too: lines that shrink must not count as lost.
      detector.detect(withNoise(image_after, 1.0, 2.0, random), 20.0F, after);
      for (const LineSegment& line : lines) {
        const auto expected = clip({moved(motion, line.start), moved(motion, line.end)},
                                   ImageBounds::ofImage(image.cols, image.rows, 6.0F));
        if (!expected || expected->length() < kMinLength) continue;
        quality.expected += 1.0;
        const auto same = [&expected](const LineSegment& found) { return sameLine(*expected, found); };
        quality.repeated += std::any_of(after.begin(), after.end(), same) ? 1.0 : 0.0;
      }
    }

    detector.detect(withNoise(image, 15.0 / cv::mean(image)[0], 1.0, random), kMinLength, lines);
    quality.dim_lines += static_cast<double>(lines.size()) / count;
  }
  quality.length /= std::max(1.0, quality.lines * count);
  const double sigmas[] = {1.0, 3.0, 8.0, 20.0, 50.0};
  for (const double sigma : sigmas) {
    detector.detect(withNoise(cv::Mat(480, 752, CV_8UC1, cv::Scalar(128)), 1.0, sigma, random), 20.0F, lines);
    quality.false_lines += static_cast<double>(lines.size()) / 5.0;
  }
  return quality;
}

void printQuality(const std::vector<cv::Mat>& images) {
  std::printf("%zu images of %dx%d, lines from %.0f px\n", images.size(), images[0].cols, images[0].rows,
              static_cast<double>(kMinLength));
  std::printf("%-9s %12s %12s %12s %16s %18s\n", "detector", "lines/image", "length [px]", "found again",
              "lines, mean 15", "false in noise");
  for (const std::string& name : tet_line_tracker::availableDetectors()) {
    const Quality q = qualityOf(*tet_line_tracker::makeLineDetector(name), images);
    std::printf("%-9s %12.1f %12.1f %10.1f %% %16.1f %18.2f\n", name.c_str(), q.lines, q.length,
                100.0 * q.repeated / std::max(1.0, q.expected), q.dim_lines, q.false_lines);
  }
}

/// Times per image; the images take turns.
template <typename Detect>
void timeOver(benchmark::State& state, const std::vector<cv::Mat>& images, Detect detect) {
  std::size_t next = 0;
  for (auto _ : state) {
    detect(images[next]);
    next = (next + 1) % images.size();
  }
}

void registerTimes(const std::vector<cv::Mat>& images) {
  for (const std::string& name : tet_line_tracker::availableDetectors()) {
    benchmark::RegisterBenchmark(name.c_str(), [name, &images](benchmark::State& state) {
      const auto detector = tet_line_tracker::makeLineDetector(name);
      std::vector<LineSegment> lines;
      timeOver(state, images, [&](const cv::Mat& image) { detector->detect(image, kMinLength, lines); });
    })->Unit(benchmark::kMillisecond);
  }
#ifdef TET_HAVE_XIMGPROC
  benchmark::RegisterBenchmark("cv::ximgproc::EdgeDrawing", [&images](benchmark::State& state) {
    const auto detector = cv::ximgproc::createEdgeDrawing();
    std::vector<cv::Vec4f> lines;
    timeOver(state, images, [&](const cv::Mat& image) {
      detector->detectEdges(image);
      detector->detectLines(lines);
    });
  })->Unit(benchmark::kMillisecond);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: detector_benchmark IMAGE_DIRECTORY [--benchmark_...]\n");
    return 1;
  }
  std::vector<cv::String> files;
  cv::glob(std::string(argv[1]) + "/*.png", files);
  std::vector<cv::Mat> images;
  const std::size_t step = std::max<std::size_t>(1, files.size() / kImages);
  for (std::size_t i = 0; i < files.size() && images.size() < kImages; i += step) {
    const cv::Mat image = cv::imread(files[i], cv::IMREAD_GRAYSCALE);
    if (!image.empty()) images.push_back(image);
  }
  if (images.empty()) {
    std::fprintf(stderr, "no PNG images in %s\n", argv[1]);
    return 1;
  }
  cv::setNumThreads(1);
  printQuality(images);
  registerTimes(images);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
