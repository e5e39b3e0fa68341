#include "tet_line_tracker/detection/line_detector.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>
#include <tuple>

#include <opencv2/core/version.hpp>

#include "detection/edge_detector.h"
#include "detection/fld_detector.h"
#include "detection/lsd_detector.h"
#include "image/mask.h"

namespace tet_line_tracker {

namespace {

bool longerFirst(const LineSegment& a, const LineSegment& b) {
  const auto key = [](const LineSegment& line) {
    return std::make_tuple(-(line.end - line.start).squaredNorm(), line.start.y(), line.start.x(),
                           line.end.y(), line.end.x());
  };
  return key(a) < key(b);
}

void requireGrayBytes(const cv::Mat& image, const char* what) {
  if (image.type() == CV_8UC1) return;
  throw std::invalid_argument(std::string(what) + " must have 8 bits and one channel, but has OpenCV type " +
                              std::to_string(image.type()));
}

using Factory = std::function<std::unique_ptr<LineDetector>()>;

struct Candidate {
  std::string name;
  Factory make;
};

/// All detectors this build knows, best first; whether they work is another matter.
const std::vector<Candidate>& candidates() {
  static const std::vector<Candidate> kCandidates = {
      {"edge", [] { return std::make_unique<EdgeDetector>(); }},
      {"lsd", [] { return std::make_unique<LsdDetector>(); }},
#ifdef TET_HAVE_XIMGPROC
      {"fld", [] { return std::make_unique<FldDetector>(); }},
#endif
  };
  return kCandidates;
}

/// Whether the detector can be made and finds the one edge of a small image.
bool works(const Candidate& candidate) {
  try {
    cv::Mat image(64, 64, CV_8UC1, cv::Scalar(40));
    image.colRange(32, 64).setTo(200);
    std::vector<LineSegment> lines;
    candidate.make()->detect(image, 20.0F, lines);
    return !lines.empty();
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace

void LineDetector::detect(const cv::Mat& gray, float min_length, std::vector<LineSegment>& lines,
                          const DetectionHints& hints) {
  const cv::Mat& mask = hints.mask;
  lines.clear();
  if (gray.empty()) return;
  requireGrayBytes(gray, "the image");
  if (!mask.empty()) {
    requireGrayBytes(mask, "the mask");
    if (mask.size() != gray.size()) {
      throw std::invalid_argument("the mask must be as large as the image (" + std::to_string(gray.cols) +
                                  "x" + std::to_string(gray.rows) + "), but is " + std::to_string(mask.cols) +
                                  "x" + std::to_string(mask.rows));
    }
  }
  find(gray, min_length, hints, lines);

  const ImageBounds bounds = ImageBounds::ofImage(gray.cols, gray.rows);
  std::size_t kept = 0;
  for (const LineSegment& line : lines) {
    const std::optional<LineSegment> clipped = clip(line, bounds);
    if (!clipped || !(clipped->length() > 0.0F) || clipped->length() < min_length) continue;
    if (!mask.empty() && !mostlyInMask(*clipped, mask)) continue;
    lines[kept++] = *clipped;
  }
  lines.resize(kept);
  std::sort(lines.begin(), lines.end(), longerFirst);
}

std::vector<std::string> availableDetectors() {
  static const std::vector<std::string> kAvailable = [] {
    std::vector<std::string> names;
    for (const Candidate& candidate : candidates()) {
      if (works(candidate)) names.push_back(candidate.name);
    }
    return names;
  }();
  return kAvailable;
}

std::unique_ptr<LineDetector> makeLineDetector(const std::string& name,
                                               const std::vector<std::string>& preferred) {
  const std::vector<std::string> available = availableDetectors();
  for (const std::string& wanted : name == "auto" ? preferred : std::vector<std::string>{name}) {
    if (std::find(available.begin(), available.end(), wanted) == available.end()) continue;
    for (const Candidate& candidate : candidates()) {
      if (candidate.name == wanted) return candidate.make();
    }
  }
  std::string list;
  for (const std::string& other : available) list += (list.empty() ? "" : ", ") + other;
  throw std::invalid_argument("the line detector '" + name +
                              "' is not available with OpenCV " CV_VERSION "; available: " +
                              (list.empty() ? "none" : "auto, " + list));
}

}  // namespace tet_line_tracker
