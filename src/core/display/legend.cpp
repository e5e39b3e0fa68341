#include "display/legend.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include <opencv2/imgproc.hpp>

#include "display/drawing.h"
#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

constexpr double kTextSize = 0.4;
constexpr double kTickSize = 0.34;
const cv::Scalar kTextColour = cv::Scalar::all(235);

/// Without the last words as long as it is wider than `width`, so that the rest can be read.
std::string fitting(std::string text, int width, const cv::Mat& image) {
  while (!text.empty() && textExtent(text, kTextSize, image).width > width) {
    text.resize(std::min(text.rfind(' '), text.size() - 1));
  }
  return text;
}

}  // namespace

/// A switch, so that the compiler tells of a reason without a name.
const char* nameOf(LossReason reason) {
  switch (reason) {
    case LossReason::kFlow:
      return "flow";
    case LossReason::kResidual:
      return "residual";
    case LossReason::kLengthRatio:
      return "length ratio";
    case LossReason::kAngle:
      return "angle";
    case LossReason::kSupport:
      return "support";
    case LossReason::kBorder:
      return "border";
    case LossReason::kShort:
      return "short";
    case LossReason::kFieldOfView:
      return "field of view";
    case LossReason::kMask:
      return "mask";
    case LossReason::kDepth:
      return "depth";
    case LossReason::kEdgeJump:
      return "edge jump";
    case LossReason::kDuplicate:
      return "duplicate";
    case LossReason::kCount:
      break;
  }
  return "";
}

cv::Rect legendArea(const cv::Size& size) {
  const double scale = drawingScale(cv::Mat(size, CV_8UC1));
  const int height = cvRound(38 * scale);
  if (size.height < 4 * height || size.width < cvRound(300 * scale)) return {};
  return {0, size.height - height, size.width, height};
}

std::string legendText(const LineFrame& frame) {
  std::string text = std::to_string(frame.lines.size()) + " lines";
  if (frame.statistics.total_ms > 0.0) {
    char time[32];
    std::snprintf(time, sizeof(time), "   %.2f ms", frame.statistics.total_ms);
    text += time;
  }
  text += "   image " + std::to_string(frame.image_count) + "   epoch " + std::to_string(frame.epoch);
  if (frame.detected) text += "   detected";
  return text;
}

std::string lossText(const FrameStatistics& statistics) {
  std::size_t total = 0;
  std::string reasons;
  for (std::size_t i = 0; i < statistics.lost.size(); ++i) {
    if (statistics.lost[i] == 0) continue;
    total += statistics.lost[i];
    reasons += (reasons.empty() ? "" : ", ") + std::string(nameOf(static_cast<LossReason>(i))) + " " +
               std::to_string(statistics.lost[i]);
  }
  return total == 0 ? "" : std::to_string(total) + " lost: " + reasons;
}

void drawLegend(const LineFrame& frame, cv::Mat& bgr) {
  const cv::Rect area = legendArea(bgr.size());
  if (area.empty()) return;
  const double scale = drawingScale(bgr);
  cv::Mat strip = bgr(area);
  strip.convertTo(strip, -1, 0.25);

  // Text is of the size that suits the whole image.
  const auto write = [&](const std::string& text, int x, int y, double size,
                         const cv::Scalar& colour = kTextColour) {
    drawText(text, {x, area.y + cvRound(y * scale)}, size, colour, bgr);
  };

  const int left = cvRound(10 * scale);
  const int bar_width = cvRound(150 * scale);
  for (int x = 0; x < bar_width; ++x) {
    const double age = std::pow(static_cast<double>(kOldestColouredAge), x / (bar_width - 1.0));
    const std::array<float, 3> rgb = colourOfAge(static_cast<std::uint32_t>(std::lround(age)));
    cv::line(strip, {left + x, cvRound(5 * scale)}, {left + x, cvRound(13 * scale)},
             {255.0 * rgb[2], 255.0 * rgb[1], 255.0 * rgb[0]});
  }
  for (const std::uint32_t age : {1U, 3U, 10U, 30U, kOldestColouredAge}) {
    const int x = cvRound(bar_width * std::log(age) / std::log(kOldestColouredAge));
    write(std::to_string(age), left + x - cvRound(4 * scale), 28, kTickSize);
  }
  const int text_left = left + bar_width + cvRound(26 * scale);
  const int width = area.width - text_left - left;
  write(fitting("age [images]   " + legendText(frame), width, bgr), text_left, 14, kTextSize);
  write(fitting(lossText(frame.statistics), width, bgr), text_left, 30, kTextSize, kLossColour);
}

}  // namespace tet_line_tracker
