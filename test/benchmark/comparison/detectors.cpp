#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/baselines/edge_drawing_detector.h"
#include "evaluation/pose_track.h"
#include "evaluation/scene_truth.h"
#include "sections.h"
#include "simulation/simulation.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "timing.h"

namespace tet_line_tracker {
namespace {

constexpr float kMinLength = 30.0F;       // [px]
constexpr float kMinLengthAgain = 20.0F;  // lines that shrink in the other image must not count as lost [px]
constexpr float kMaxDistance = 2.0F;      // [px]
constexpr float kMaxAngle = 0.1F;         // [rad]

using Lines = std::vector<LineSegment>;

/// A detector and its name in the table.
struct Contender {
  std::string name;
  std::shared_ptr<LineDetector> detector;

  void detect(const cv::Mat& image, float min_length, Lines& lines) {
    detector->detect(image, min_length, lines);
  }
};

std::vector<Contender> contenders() {
  std::vector<Contender> all;
  const std::vector<std::string> available = availableDetectors();
  for (const char* const name : {"lsd", "edge", "fld"}) {
    if (std::find(available.begin(), available.end(), name) == available.end()) continue;
    all.push_back({name, makeLineDetector(name)});
  }
  if (auto edge_drawing = makeEdgeDrawingDetector()) {
    all.push_back({"cv::ximgproc::EdgeDrawing", std::move(edge_drawing)});
  }
  return all;
}

/// Some images of a simulated flight, and what is true in them.
class Flight {
 public:
  Flight(const std::string& label, const SimulationOptions& options) : label_(label) {
    Simulation simulation(options, camera_);
    PoseTrack poses;
    for (int i = 0; i < simulation.imageCount(); ++i) {
      stamps_.push_back(simulation.imageStamp(i));
      poses.add(stamps_.back(),
                simulation.trajectory().worldFromCamera(simulation.timeOf(simulation.imageStamp(i))));
      images_.push_back(simulation.nextImage().clone());
    }
    poses.sort();
    truth_ = std::make_unique<SceneTruth>(simulation.geometry(), poses, camera_);
  }

  /// Lines of each image that should be in the next one, and how many are.
  struct Repeated {
    double lines{0}, expected{0}, found{0};
  };
  Repeated repeat(Contender& contender) const {
    Repeated result;
    Lines lines, lines_after;
    for (std::size_t i = 0; i + 1 < images_.size(); ++i) {
      contender.detect(images_[i], kMinLength, lines);
      contender.detect(images_[i + 1], kMinLengthAgain, lines_after);
      result.lines += static_cast<double>(lines.size()) / static_cast<double>(images_.size() - 1);
      for (const LineSegment& line : lines) {
        const auto expected = moved(line, stamps_[i], stamps_[i + 1]);
        if (!expected || expected->length() < kMinLength) continue;
        result.expected += 1.0;
        result.found += std::any_of(lines_after.begin(), lines_after.end(),
                                    [&](const LineSegment& after) { return same(*expected, after); });
      }
    }
    return result;
  }
  const std::string& label() const { return label_; }

 private:
  /// The line where the truth moves it to, when both its ends stay in view.
  std::optional<LineSegment> moved(const LineSegment& line, std::int64_t from, std::int64_t to) const {
    const Eigen::Vector2d normal = line.normal().cast<double>();
    Eigen::Vector2f ends[2];
    for (const int end : {0, 1}) {
      // The very end is often off the edge.
      const Eigen::Vector2d pixel = line.at(end == 0 ? 0.05F : 0.95F).cast<double>();
      const auto point = truth_->lift(from, pixel, normal);
      const auto view = point ? truth_->view(*point, to) : std::nullopt;
      if (!view || !view->in_picture || view->hidden) return std::nullopt;
      ends[end] = view->pixel.cast<float>();
    }
    return LineSegment{ends[0], ends[1]};
  }

  static bool same(const LineSegment& expected, const LineSegment& found) {
    // Not all contenders order their ends by the brighter side.
    const float angle = angleBetween(expected, found);
    if (std::min(angle, static_cast<float>(CV_PI) - angle) > kMaxAngle) return false;
    const bool found_longer = found.length() > expected.length();
    const LineSegment& longer = found_longer ? found : expected;
    const LineSegment& shorter = found_longer ? expected : found;
    return overlap(shorter, longer) >= 0.5F && std::abs(longer.distance(shorter.start)) < kMaxDistance &&
           std::abs(longer.distance(shorter.end)) < kMaxDistance;
  }

  std::string label_;
  std::shared_ptr<const CameraModel> camera_{makeCameraModel(defaultSimulatedCamera())};
  std::vector<std::int64_t> stamps_;
  std::vector<cv::Mat> images_;
  std::unique_ptr<SceneTruth> truth_;
};

std::vector<Flight> flights() {
  constexpr int kImages = 12;
  std::vector<Flight> all;
  for (const auto& [label, motion, light] : {std::array<const char*, 3>{"slow", "slow", "normal"},
                                             {"fast", "fast", "normal"},
                                             {"corridor", "corridor", "normal"},
                                             {"low light", "slow", "low"},
                                             {"hand shake", "shake", "normal"},
                                             {"gain jumps", "slow", "gain_jumps"}}) {
    SimulationOptions options;
    options.seed = 1001;  // those below 1000 are for tuning
    options.motion = motion;
    options.light = light;
    options.seconds = (kImages - 1) / options.rate_hz;
    options.threads = 2;
    all.emplace_back(label, options);
  }
  return all;
}

/// Lines per image of noise alone, from kMinLengthAgain on.
double falseLines(Contender& contender) {
  constexpr int kImages = 5;
  double count = 0.0;
  cv::RNG random(5);
  Lines lines;
  for (const double sigma : {1.0, 3.0, 8.0, 20.0, 50.0}) {
    for (int i = 0; i < kImages; ++i) {
      cv::Mat noise(480, 752, CV_32FC1);
      random.fill(noise, cv::RNG::NORMAL, 128.0, sigma);
      cv::Mat image;
      noise.convertTo(image, CV_8U);
      contender.detect(image, kMinLengthAgain, lines);
      count += static_cast<double>(lines.size()) / (5.0 * kImages);
    }
  }
  return count;
}

}  // namespace

void compareDetectors(const Sequence& sequence, std::size_t images) {
  std::vector<Contender> all = contenders();
  std::vector<Times> times(all.size());
  Lines lines;
  for (std::size_t first = 0; first < images; first += sequence.size()) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].detect(sequence.image(first), kMinLength, lines);
      for (std::size_t i = first; i < std::min(images, first + sequence.size()); ++i) {
        times[k].add([&] { all[k].detect(sequence.image(i), kMinLength, lines); });
      }
    }
  }
  std::printf("\n## Line detectors [ms]\n");
  TimeTable table("detector, lines from 30 px on");
  for (std::size_t k = 0; k < all.size(); ++k) table.add(all[k].name, times[k]);
  table.print(0);

  std::printf(
      "\nLines from 30 px on of simulated flights that are found again in the next image within 2 px of "
      "where the truth moves them, and lines per image; last, false lines per image of noise (20 px and "
      "longer):\n\n| detector |");
  const std::vector<Flight> regimes = flights();
  for (const Flight& flight : regimes) std::printf(" %s |", flight.label().c_str());
  std::printf(" false lines |\n|---|---|");
  for (std::size_t i = 0; i < regimes.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (Contender& contender : all) {
    std::printf("| %s |", contender.name.c_str());
    for (const Flight& flight : regimes) {
      const Flight::Repeated r = flight.repeat(contender);
      std::printf(" %.1f %% of %.0f |", 100.0 * r.found / std::max(1.0, r.expected), r.lines);
    }
    std::printf(" %.2f |\n", falseLines(contender));
    std::fflush(stdout);
  }
}

}  // namespace tet_line_tracker
