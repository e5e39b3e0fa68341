// Google Benchmark of each stage over image sizes and numbers of lines, and of each kernel on each path.
#include <array>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "comparison/sequence.h"
#include "kernels/kernels.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/motion/motion_prior.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

constexpr int kLevels = 3;
constexpr float kMinLength = 12.0F;  // short enough for 400 lines [px]

/// A few images of a simulated flight in the size of the benchmark's arguments.
const Sequence& flight(int width, int height) {
  static const Sequence original = Sequence::simulated("slow", 8);
  static std::vector<std::pair<cv::Size, Sequence>> scaled;
  for (const auto& known : scaled) {
    if (known.first == cv::Size(width, height)) return known.second;
  }
  scaled.reserve(16);
  scaled.emplace_back(cv::Size(width, height), original.resized({width, height}));
  return scaled.back().second;
}

const Sequence& flight(const benchmark::State& state) {
  return flight(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
}

std::vector<LineSegment> linesOf(const cv::Mat& image, std::int64_t count) {
  std::vector<LineSegment> lines;
  makeLineDetector("edge")->detect(image, kMinLength, lines);
  if (lines.size() > static_cast<std::size_t>(count)) lines.resize(static_cast<std::size_t>(count));
  return lines;
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"width", "height"});
  for (const auto& [width, height] :
       {std::pair{320, 240}, {640, 480}, {752, 480}, {1280, 720}, {1920, 1080}}) {
    benchmark->Args({width, height});
  }
}

void pyramid(benchmark::State& state) {
  const Sequence& images = flight(state);
  ImagePyramid pyramid;
  std::size_t i = 0;
  for (auto _ : state) pyramid.build(images.image(i++), kLevels);
}
BENCHMARK(pyramid)->Apply(sizes);

void imagePrior(benchmark::State& state) {
  const Sequence& images = flight(state);
  std::array<ImagePyramid, 2> pyramids;
  for (std::size_t i = 0; i < 2; ++i) pyramids[i].build(images.image(i), MotionPrior::kPyramidLevels);
  MotionPriorParameters parameters;
  parameters.prior = "image";
  MotionPrior prior(parameters);
  prior.setCamera(images.camera());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(prior.predict(pyramids[i % 2], Sequence::stamp(i)));
    ++i;
  }
}
BENCHMARK(imagePrior)->Apply(sizes);

void detector(benchmark::State& state) {
  const Sequence& images = flight(state);
  const auto detector = makeLineDetector("edge");
  std::vector<LineSegment> lines;
  std::size_t i = 0;
  for (auto _ : state) detector->detect(images.image(i++), 30.0F, lines);
}
BENCHMARK(detector)->Apply(sizes);

void frontEnd(benchmark::State& state) {
  const Sequence& images = flight(state);
  LineTrackerParameters parameters;
  parameters.motion.prior = "image";
  parameters.detection.max_lines = 100;
  LineTracker tracker(parameters);
  tracker.setCamera(images.camera());
  std::size_t i = 0;
  for (auto _ : state) {
    tracker.process(images.image(i), Sequence::stamp(i));
    ++i;
  }
}
BENCHMARK(frontEnd)->Apply(sizes);

/// Templates and flow of many lines.
void flow(benchmark::State& state, bool paper) {
  const Sequence& images = flight(752, 480);
  const std::vector<LineSegment> lines = linesOf(images.image(0), state.range(0));
  std::array<ImagePyramid, 2> pyramids;
  for (std::size_t i = 0; i < 2; ++i) pyramids[i].build(images.image(i), kLevels);
  const auto tracker =
      paper ? makeTwoEndpointFlow(EndpointTrackerParameters()) : makeJointFlow(EndpointTrackerParameters());
  std::vector<LineTemplate> templates(lines.size());
  for (auto _ : state) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      tracker->extractTemplate(pyramids[0], lines[i], templates[i]);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      benchmark::DoNotOptimize(tracker->track(templates[i], pyramids[1], lines[i]));
    }
  }
  state.counters["lines"] = static_cast<double>(lines.size());
}
BENCHMARK_CAPTURE(flow, joint, false)->ArgName("lines")->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Arg(400);
BENCHMARK_CAPTURE(flow, paper, true)->ArgName("lines")->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Arg(400);

void edgeRefit(benchmark::State& state) {
  const cv::Mat& image = flight(752, 480).image(0);
  const std::vector<LineSegment> lines = linesOf(image, state.range(0));
  const LineRefiner refiner(LineRefinerParameters{});
  for (auto _ : state) {
    for (const LineSegment& line : lines) benchmark::DoNotOptimize(refiner.fit(image, line, 20.0F));
  }
  state.counters["lines"] = static_cast<double>(lines.size());
}
BENCHMARK(edgeRefit)->ArgName("lines")->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Arg(400);

/// The kernels on one path, on patches, profiles and rows of a real image.
class KernelBench {
 public:
  explicit KernelBench(const kernels::KernelTable& table) : table_(table) {
    template_.gray = values_.data();
    template_.gradient_x = values_.data() + floats_;
    template_.gradient_y = values_.data() + 2 * floats_;
  }

  void halveRow(benchmark::State& state) {
    std::vector<std::uint16_t> row(static_cast<std::size_t>(image_.cols) + kernels::kRowPadding);
    std::vector<std::uint8_t> half(static_cast<std::size_t>(image_.cols));
    for (auto _ : state) {
      table_.halveRow(image_.ptr(100), image_.ptr(101), image_.ptr(102), image_.cols, row.data(),
                      half.data());
      benchmark::ClobberMemory();
    }
  }
  void makeTemplate(benchmark::State& state) {
    for (auto _ : state) {
      table_.makeTemplate(next(), shape_, true, &template_);
      benchmark::ClobberMemory();
    }
  }
  void align(benchmark::State& state) {
    table_.makeTemplate(next(), shape_, true, &template_);
    kernels::AlignmentSums sums{};
    for (auto _ : state) {
      table_.align(next(), shape_, template_, patch_.data(), &sums);
      benchmark::DoNotOptimize(sums);
    }
  }
  void subtract(benchmark::State& state) {
    table_.makeTemplate(next(), shape_, false, &template_);
    kernels::DifferenceSums sums{};
    for (auto _ : state) {
      table_.subtract(next(), shape_, template_, &sums);
      benchmark::DoNotOptimize(sums);
    }
  }
  void findEdges(benchmark::State& state) {
    kernels::ProfileBatch batch{};
    batch.step = static_cast<std::ptrdiff_t>(image_.step[0]);
    batch.count = 9;
    batch.polarity = 1.0F;
    batch.distance_scale = 0.3F;
    batch.peak_share = 0.3F;
    for (int lane = 0; lane < kernels::kLanes; ++lane) {
      batch.pixels[lane] = image_.ptr(100 + lane) + 200 + 2 * lane;
      batch.centre[lane] = 4.0F;
    }
    std::array<float, kernels::kLanes> places{}, slopes{}, widths{};
    for (auto _ : state) {
      table_.findEdges(batch, places.data(), slopes.data(), widths.data());
      benchmark::ClobberMemory();
    }
  }
  void gradientRow(benchmark::State& state) {
    const std::uint8_t* const rows[5] = {image_.ptr(100), image_.ptr(101), image_.ptr(102), image_.ptr(103),
                                         image_.ptr(104)};
    const auto width = static_cast<std::size_t>(image_.cols);
    std::vector<std::int16_t> smooth(width), slope(width), magnitude(width);
    std::vector<kernels::Gradient> gradient(width);
    for (auto _ : state) {
      table_.gradientRow(rows, image_.cols, smooth.data(), slope.data(), gradient.data(), magnitude.data());
      benchmark::ClobberMemory();
    }
  }

 private:
  kernels::PatchPlace next() {
    place_ = (place_ + 37) % 400;
    return {image_.ptr(place_) + place_ + 1, static_cast<std::ptrdiff_t>(image_.step[0]), 0.3F, 0.6F};
  }

  const kernels::KernelTable& table_;
  const cv::Mat image_{flight(752, 480).image(0)};
  const kernels::PatchShape shape_{kernels::PatchShape::ofSide(7)};
  const std::size_t floats_{static_cast<std::size_t>(shape_.floats())};
  std::vector<float> values_ = std::vector<float>(3 * floats_);
  std::vector<float> patch_ = std::vector<float>(floats_);
  kernels::PatchTemplate template_{};
  int place_{0};
};

void registerKernels() {
  using Method = void (KernelBench::*)(benchmark::State&);
  const std::pair<const char*, Method> methods[] = {
      {"halveRow", &KernelBench::halveRow},   {"makeTemplate", &KernelBench::makeTemplate},
      {"align", &KernelBench::align},         {"subtract", &KernelBench::subtract},
      {"findEdges", &KernelBench::findEdges}, {"gradientRow", &KernelBench::gradientRow}};
  int count = 0;
  const kernels::KernelTable* const* tables = kernels::available(&count);
  for (const auto& [name, method] : methods) {
    for (int i = 0; i < count; ++i) {
      const kernels::KernelTable& table = *tables[i];
      benchmark::RegisterBenchmark((std::string(name) + "/" + table.name).c_str(),
                                   [&table, method = method](benchmark::State& state) {
                                     KernelBench bench(table);
                                     (bench.*method)(state);
                                   });
    }
  }
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  tet_line_tracker::registerKernels();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
