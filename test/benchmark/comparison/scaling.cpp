#include <cstdio>
#include <functional>

#include "sections.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/tracking/line_tracker.h"
#include "timing.h"

namespace tet_line_tracker {
namespace {

struct Costs {
  double pyramid, prior, flow, detector;  ///< median per image [ms]
  double tracker;                         ///< mean per image [ms]: the detector runs on some only
  double lines;                           ///< per image
};

Costs costsOf(const Sequence& sequence, std::size_t images, const LineTrackerParameters& parameters) {
  LineTracker tracker(parameters);
  tracker.setCamera(sequence.camera());
  const auto detector = makeLineDetector("edge");
  std::vector<LineSegment> found;
  ImagePyramid pyramid;
  Times pyramid_times, prior_times, flow_times, detector_times, tracker_times;
  Costs costs{};
  for (std::size_t i = 0; i < images; ++i) {
    const cv::Mat& image = sequence.image(i);
    const LineFrame* frame = nullptr;
    const auto track = [&] { frame = tracker.process(image, Sequence::stamp(i)).frame; };
    if (i == 0) {
      track();
      continue;
    }
    pyramid_times.add([&] { pyramid.build(image, 3); });
    detector_times.add([&] { detector->detect(image, 30.0F, found); });
    tracker_times.add(track);
    prior_times.put(frame->statistics.prior_ms);
    flow_times.put(frame->statistics.flow_ms);
    costs.lines += static_cast<double>(frame->lines.size()) / static_cast<double>(images - 1);
  }
  costs.pyramid = pyramid_times.median();
  costs.prior = prior_times.median();
  costs.flow = flow_times.median();
  costs.detector = detector_times.median();
  costs.tracker = tracker_times.mean();
  return costs;
}

void printExponents(const char* label, const std::vector<double>& sizes, const std::vector<Costs>& costs,
                    const std::vector<double Costs::*>& stages) {
  std::printf("| %s |", label);
  for (const auto stage : stages) {
    std::vector<double> values;
    for (const Costs& cost : costs) values.push_back(cost.*stage);
    std::printf(" %.2f |", fittedExponent(sizes, values));
  }
  std::printf("\n");
}

}  // namespace

void showScaling(const Sequence& sequence, std::size_t images) {
  LineTrackerParameters parameters;
  parameters.motion.prior = "image";
  parameters.detection.max_lines = 100;

  std::printf(
      "\n## Cost against pixels, at most 100 lines [ms per image]\n\n"
      "| size | pyramid | image prior | flow and re-fit | detector | whole front end | lines |\n"
      "|---|---|---|---|---|---|---|\n");
  std::vector<double> sizes;
  std::vector<Costs> costs;
  for (const cv::Size size : {cv::Size(320, 240), cv::Size(640, 480), cv::Size(752, 480), cv::Size(1280, 720),
                              cv::Size(1920, 1080)}) {
    const Costs c = costsOf(sequence.resized(size), images, parameters);
    std::printf("| %dx%d | %.3f | %.3f | %.3f | %.3f | %.3f | %.0f |\n", size.width, size.height, c.pyramid,
                c.prior, c.flow, c.detector, c.tracker, c.lines);
    sizes.push_back(size.area());
    costs.push_back(c);
  }
  printExponents("exponent", sizes, costs,
                 {&Costs::pyramid, &Costs::prior, &Costs::flow, &Costs::detector, &Costs::tracker});

  std::printf(
      "\n## Cost against lines, %dx%d [ms per image]\n\n"
      "| lines | flow and re-fit | whole front end |\n|---|---|---|\n",
      sequence.image(0).cols, sequence.image(0).rows);
  sizes.clear();
  costs.clear();
  // Short ones too, so that there are enough.
  parameters.detection.min_length = 12.0;
  for (const int lines : {25, 50, 100, 200, 400}) {
    parameters.detection.max_lines = lines;
    parameters.detection.min_lines = lines / 2;
    const Costs c = costsOf(sequence, images, parameters);
    std::printf("| %.0f | %.3f | %.3f |\n", c.lines, c.flow, c.tracker);
    sizes.push_back(c.lines);
    costs.push_back(c);
  }
  printExponents("exponent", sizes, costs, {&Costs::flow, &Costs::tracker});
}

}  // namespace tet_line_tracker
