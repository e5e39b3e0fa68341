#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "evaluation/baselines/baseline_tracker.h"
#include "sections.h"
#include "tet_line_tracker/tracking/line_tracker.h"
#include "timing.h"

namespace tet_line_tracker {
namespace {

using Process = std::function<const LineFrame*(const cv::Mat&, std::int64_t)>;

struct Contender {
  std::string name;
  Process process;
  Times times{};
  std::size_t lines{0};
};

LineTrackerParameters ours(int max_lines) {
  LineTrackerParameters parameters;
  parameters.motion.prior = "image";
  parameters.detection.max_lines = max_lines;
  return parameters;
}

Contender trackerOf(const std::string& name, const LineTrackerParameters& parameters,
                    const Sequence& sequence) {
  const auto tracker = std::make_shared<LineTracker>(parameters);
  tracker->setCamera(sequence.camera());
  return {name,
          [tracker](const cv::Mat& gray, std::int64_t stamp) { return tracker->process(gray, stamp).frame; }};
}

Contender baselineOf(const std::string& name, const std::string& baseline, const Sequence& sequence) {
  const std::shared_ptr<BaselineTracker> tracker = makeBaselineTracker(baseline, ours(1000));
  tracker->setCamera(sequence.camera());
  return {name,
          [tracker](const cv::Mat& gray, std::int64_t stamp) { return tracker->process(gray, stamp).frame; }};
}

}  // namespace

void compareFrontEnds(const Sequence& sequence, std::size_t images) {
  std::vector<Contender> contenders;
  for (const std::string& name : baselineNames()) {
    static const std::map<std::string, std::string> kTitles{{"lsd_lbd_knn", "LSD + LBD + KNN"},
                                                            {"ed_lbd_knn", "EdgeDrawing + LBD + KNN"},
                                                            {"fld_lbd_knn", "FLD + LBD + KNN"},
                                                            {"lk_endpoints", "LSD + OpenCV's LK"},
                                                            {"lsd_remapped", "LSD on undistorted images"}};
    contenders.push_back(baselineOf(kTitles.at(name), name, sequence));
  }
  contenders.push_back(trackerOf("method: joint, 100 lines", ours(100), sequence));
  contenders.push_back(trackerOf("method: joint, 150 lines (default)", ours(150), sequence));
  LineTrackerParameters paper = ours(150);
  paper.method = "paper";
  contenders.push_back(trackerOf("method: paper", paper, sequence));
  paper.detection.detector = "edge";
  contenders.push_back(trackerOf("method: paper, detector: edge", paper, sequence));

  std::size_t reference = 0;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    if (contenders[i].name == "LSD + LBD + KNN") reference = i;
  }
  // A turn for each in blocks: all see the same weather on the machine, and its own cache.
  for (std::size_t first = 0; first < images; first += sequence.size()) {
    for (Contender& contender : contenders) {
      for (std::size_t i = first; i < std::min(images, first + sequence.size()); ++i) {
        const LineFrame* frame = nullptr;
        Times times;
        const auto process = [&] { frame = contender.process(sequence.image(i), Sequence::stamp(i)); };
        // On the first image buffers and tables are made.
        (i == 0 ? times : contender.times).add(process);
        contender.lines += frame->lines.size();
      }
    }
  }
  std::printf("\n## Whole front end, per image [ms]\n");
  TimeTable table("front end", "lines per image");
  for (const Contender& contender : contenders) {
    const double lines = static_cast<double>(contender.lines) / static_cast<double>(images);
    table.add(contender.name, contender.times, std::to_string(static_cast<int>(lines + 0.5)));
  }
  table.print(reference);
}

}  // namespace tet_line_tracker
