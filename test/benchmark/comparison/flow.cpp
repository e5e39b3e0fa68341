#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "sections.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "timing.h"

namespace tet_line_tracker {
namespace {

constexpr int kLevels = 3;
constexpr int kWindow = 7;
constexpr std::size_t kLines = 100;

/// OpenCV's flow with the paper's values.
struct OpenCvFlow {
  std::vector<cv::Point2f> found{};
  std::vector<uchar> status{};
  std::vector<float> errors{};

  template <typename Images>
  void run(const Images& first, const Images& second, const std::vector<cv::Point2f>& points) {
    cv::calcOpticalFlowPyrLK(first, second, points, found, status, errors, cv::Size(kWindow, kWindow),
                             kLevels - 1, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 10, 0.01});
  }
};

std::vector<LineSegment> longestLines(LineDetector& detector, const cv::Mat& image) {
  std::vector<LineSegment> lines;
  detector.detect(image, 20.0F, lines);
  lines.resize(std::min(lines.size(), kLines));
  return lines;
}

std::vector<cv::Point2f> endpointsOf(const std::vector<LineSegment>& lines) {
  std::vector<cv::Point2f> points;
  for (const LineSegment& line : lines) {
    points.emplace_back(line.start.x(), line.start.y());
    points.emplace_back(line.end.x(), line.end.y());
  }
  return points;
}

/// Ours: template in the first image, then the flow, line by line.
class PaperFlow {
 public:
  void run(const ImagePyramid& first, const ImagePyramid& second, const std::vector<LineSegment>& lines) {
    flows.resize(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      tracker_->extractTemplate(first, lines[i], patches_);
      flows[i] = tracker_->track(patches_, second, lines[i]);
    }
  }
  std::vector<EndpointFlow> flows;

 private:
  std::unique_ptr<EndpointTracker> tracker_{makeTwoEndpointFlow(EndpointTrackerParameters())};
  LineTemplate patches_;
};

void printErrors(const char* name, std::vector<double>& errors, double found) {
  std::sort(errors.begin(), errors.end());
  const auto at = [&errors](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  std::printf("| %s | %.1f %% | %.4f | %.4f | %.4f |\n", name, 100.0 * found, at(0.5), at(0.9), at(0.99));
}

/// Errors on images that are moved by known parts of a pixel.
void compareErrors(const Sequence& sequence, LineDetector& detector) {
  PaperFlow paper;
  OpenCvFlow opencv;
  std::vector<double> our_errors, their_errors;
  double wanted = 0.0;
  double our_share = 0.0;
  double their_share = 0.0;
  cv::RNG random(3);
  for (std::size_t i = 0; i < sequence.size(); i += std::max<std::size_t>(1, sequence.size() / 20)) {
    // A little blur: what is finer than pixels cannot be moved by parts of one.
    cv::Mat image;
    cv::GaussianBlur(sequence.image(i), image, cv::Size(0, 0), 1.0);
    const Eigen::Vector2f shift(random.uniform(-4.0F, 4.0F), random.uniform(-4.0F, 4.0F));
    const cv::Matx23f motion(1.0F, 0.0F, shift.x(), 0.0F, 1.0F, shift.y());
    cv::Mat moved;
    cv::warpAffine(image, moved, motion, image.size(), cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
    std::vector<LineSegment> lines = longestLines(detector, image);
    const auto at_border = [&](const LineSegment& line) {
      const ImageBounds inside = ImageBounds::ofImage(image.cols, image.rows, 30.0F);
      return !inside.contains(line.start) || !inside.contains(line.end);
    };
    lines.erase(std::remove_if(lines.begin(), lines.end(), at_border), lines.end());
    ImagePyramid first, second;
    first.build(image, kLevels);
    second.build(moved, kLevels);
    paper.run(first, second, lines);
    const std::vector<cv::Point2f> points = endpointsOf(lines);
    opencv.run(image, moved, points);
    wanted += static_cast<double>(points.size());
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const LineSegment truth{lines[k].start + shift, lines[k].end + shift};
      const EndpointFlow& flow = paper.flows[k];
      // A high residual too: the comparison is of places, and OpenCV has no such test.
      const bool found =
          flow.status == EndpointFlow::Status::kTracked || flow.status == EndpointFlow::Status::kHighResidual;
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
        const bool found_by_opencv = opencv.status[2 * k + end] != 0;
        our_share += found ? 1.0 : 0.0;
        their_share += found_by_opencv ? 1.0 : 0.0;
        if (!found || !found_by_opencv) continue;
        const Eigen::Vector2f& true_place = end == 0 ? truth.start : truth.end;
        const cv::Point2f& place = opencv.found[2 * k + end];
        our_errors.push_back(((end == 0 ? flow.segment.start : flow.segment.end) - true_place).norm());
        their_errors.push_back((Eigen::Vector2f(place.x, place.y) - true_place).norm());
      }
    }
  }
  std::printf(
      "\nErrors of the endpoints that both find, on images moved by known vectors of up to 4 px a side "
      "[px]:\n\n"
      "| flow | found | median | 90 %% | 99 %% |\n|---|---|---|---|---|\n");
  printErrors("cv::calcOpticalFlowPyrLK", their_errors, their_share / wanted);
  printErrors("method: paper", our_errors, our_share / wanted);
}

}  // namespace

void compareFlow(const Sequence& sequence, std::size_t images) {
  const auto detector = makeLineDetector("edge");
  Times our_pyramid, cv_pyramid, cv_pyramid_plain, our_flow, cv_flow, cv_flow_images;
  PaperFlow paper;
  OpenCvFlow opencv;
  ImagePyramid pyramids[2];
  std::vector<cv::Mat> cv_pyramids[2], plain;
  // Flow follows its own pyramid at once, as in a tracker.
  for (std::size_t i = 0; i < images; ++i) {
    const cv::Mat& image = sequence.image(i);
    const cv::Mat& image_before = sequence.image(i == 0 ? 0 : i - 1);
    const std::vector<LineSegment> lines = longestLines(*detector, image_before);
    const std::vector<cv::Point2f> points = endpointsOf(lines);
    const cv::Size window(kWindow, kWindow);
    ImagePyramid& ours = pyramids[i % 2];
    our_pyramid.add([&] { ours.build(image, kLevels); });
    if (i > 0) our_flow.add([&] { paper.run(pyramids[(i - 1) % 2], ours, lines); });
    std::vector<cv::Mat>& theirs = cv_pyramids[i % 2];
    cv_pyramid.add([&] { cv::buildOpticalFlowPyramid(image, theirs, window, kLevels - 1); });
    if (i > 0) cv_flow.add([&] { opencv.run(cv_pyramids[(i - 1) % 2], theirs, points); });
    if (i > 0) cv_flow_images.add([&] { opencv.run(image_before, image, points); });
    cv_pyramid_plain.add([&] { cv::buildOpticalFlowPyramid(image, plain, window, kLevels - 1, false); });
  }
  std::printf("\n## Pyramid and flow of endpoints [ms]\n");
  TimeTable pyramid_table("pyramid, 3 levels");
  pyramid_table.add("cv::buildOpticalFlowPyramid", cv_pyramid);
  pyramid_table.add("cv::buildOpticalFlowPyramid without derivatives", cv_pyramid_plain);
  pyramid_table.add("ours", our_pyramid);
  pyramid_table.print(0);
  TimeTable flow_table("flow of the endpoints of 100 lines, 7x7, 3 levels, 10 iterations");
  flow_table.add("cv::calcOpticalFlowPyrLK, given its pyramids", cv_flow);
  flow_table.add("cv::calcOpticalFlowPyrLK, pyramids included", cv_flow_images);
  flow_table.add("method: paper, given its pyramids, templates included", our_flow);
  flow_table.print(0);
  compareErrors(sequence, *detector);
}

}  // namespace tet_line_tracker
