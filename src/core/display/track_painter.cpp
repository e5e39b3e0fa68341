#include "tet_line_tracker/display/track_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "display/drawing.h"
#include "display/label_placer.h"
#include "display/legend.h"
#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

cv::Scalar bgrOfAge(std::uint32_t age) {
  const std::array<float, 3> rgb = colourOfAge(age);
  return {255.0 * rgb[2], 255.0 * rgb[1], 255.0 * rgb[0]};
}

void drawLine(const LineCurve& line, const cv::Scalar& colour, cv::Mat& bgr) {
  const std::vector<cv::Point> points = fixedPoints(line);
  cv::polylines(bgr, points, false, cv::Scalar::all(20), drawingThickness(3.2, bgr), cv::LINE_AA,
                kDrawingShift);
  cv::polylines(bgr, points, false, colour, drawingThickness(1.6, bgr), cv::LINE_AA, kDrawingShift);
  const cv::Point& start = points.front();
  const cv::Point& end = points.back();
  // A full dot at the start and a ring at the end: the roles of the endpoints can be seen to stay.
  const int radius = cvRound(2.4 * drawingScale(bgr) * (1 << kDrawingShift));
  cv::circle(bgr, start, radius, colour, cv::FILLED, cv::LINE_AA, kDrawingShift);
  cv::circle(bgr, end, radius, cv::Scalar::all(20), cv::FILLED, cv::LINE_AA, kDrawingShift);
  cv::circle(bgr, end, radius, colour, drawingThickness(1, bgr), cv::LINE_AA, kDrawingShift);
}

constexpr double kLabelSize = 0.34;

/// What was lost: thin dashes with a dark rim.
void drawLost(const LineCurve& line, cv::Mat& bgr) {
  constexpr float kPeriod = 12.0F;  // [px]
  const float period = kPeriod * std::max(1.0F, static_cast<float>(drawingScale(bgr)));
  const float length = clampOrLow(line.chord.length(), 0.0F, 1e4F);
  const int dashes = 1 + static_cast<int>(length / period);
  for (int i = 0; i < dashes; ++i) {
    const float begin = (static_cast<float>(i) + 0.25F) / static_cast<float>(dashes);
    const float end = (static_cast<float>(i) + 0.75F) / static_cast<float>(dashes);
    const cv::Point from = fixedPoint(line.at(begin));
    const cv::Point to = fixedPoint(line.at(end));
    cv::line(bgr, from, to, cv::Scalar::all(20), drawingThickness(3.2, bgr), cv::LINE_AA, kDrawingShift);
    cv::line(bgr, from, to, kLossColour, drawingThickness(1.4, bgr), cv::LINE_AA, kDrawingShift);
  }
}

LossReason reasonOf(std::uint64_t id, const std::vector<LostLine>& lost) {
  const auto found =
      std::find_if(lost.begin(), lost.end(), [id](const LostLine& line) { return line.id == id; });
  return found == lost.end() ? LossReason::kCount : found->reason;
}

}  // namespace

std::array<float, 3> colourOfAge(std::uint32_t age) {
  static constexpr std::array<std::array<float, 3>, 4> kColours{
      {{1.0F, 0.25F, 0.2F}, {1.0F, 0.82F, 0.1F}, {0.25F, 0.9F, 0.35F}, {0.25F, 0.6F, 1.0F}}};
  const double oldest = std::log(static_cast<double>(kOldestColouredAge));
  const double place = std::clamp(std::log(std::max(1.0, static_cast<double>(age))) / oldest, 0.0, 1.0) *
                       static_cast<double>(kColours.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(place), kColours.size() - 2);
  const auto share = static_cast<float>(place - static_cast<double>(lower));
  std::array<float, 3> colour{};
  for (std::size_t i = 0; i < colour.size(); ++i) {
    colour[i] = (1.0F - share) * kColours[lower][i] + share * kColours[lower + 1][i];
  }
  return colour;
}

void TrackPainter::setCamera(std::shared_ptr<const CameraModel> camera) {
  if (camera == camera_) return;
  camera_ = std::move(camera);
  lens_size_ = cv::Size();
}

void TrackPainter::paint(const cv::Mat& gray, const LineFrame& frame, cv::Mat& bgr) {
  if (gray.type() != CV_8UC1 || gray.cols != frame.width || gray.rows != frame.height) {
    throw std::invalid_argument("the painted image is " + std::to_string(gray.cols) + "x" +
                                std::to_string(gray.rows) + ", needs 8-bit gray of " +
                                std::to_string(frame.width) + "x" + std::to_string(frame.height));
  }
  cv::cvtColor(gray, bgr, cv::COLOR_GRAY2BGR);
  if (lens_size_ != gray.size()) lens_ = LensBend(camera_, gray.cols, gray.rows);
  lens_size_ = gray.size();
  std::vector<Loss> losses = follow(frame);
  if (!style_.lost) losses.clear();
  for (const Loss& loss : losses) drawLost(loss.line, bgr);
  for (const TrackedLine& line : frame.lines) {
    const auto trail = trails_.find(line.id);
    if (trail != trails_.end()) drawTrail(trail->second, bgrOfAge(line.age), bgr);
  }
  std::vector<LineCurve> curves;
  curves.reserve(frame.lines.size());
  for (const TrackedLine& line : frame.lines) {
    curves.push_back(lens_.curve(line.segment));
    drawLine(curves.back(), bgrOfAge(line.age), bgr);
  }
  drawLabels(frame, curves, losses, bgr);
  if (style_.scale) drawLegend(frame, bgr);
}

void TrackPainter::drawLabels(const LineFrame& frame, const std::vector<LineCurve>& curves,
                              const std::vector<Loss>& losses, cv::Mat& bgr) const {
  if (!style_.ids && losses.empty()) return;
  LabelPlacer placer(bgr.size());
  if (style_.scale) placer.take(legendArea(bgr.size()));
  for (const LineCurve& curve : curves) placer.take(curve);
  for (const Loss& loss : losses) placer.take(loss.line);
  const auto write = [&](const std::string& text, const LineCurve& line, const cv::Scalar& colour) {
    const auto corner = placer.place(line, textExtent(text, kLabelSize, bgr));
    if (corner) drawText(text, *corner, kLabelSize, colour, bgr);
  };
  // Few, and in no other image: they come before the ids.
  for (const Loss& loss : losses) {
    if (loss.reason != LossReason::kCount) write(nameOf(loss.reason), loss.line, kLossColour);
  }
  if (!style_.ids) return;
  std::vector<std::size_t> oldest_first(curves.size());
  std::iota(oldest_first.begin(), oldest_first.end(), 0);
  std::stable_sort(oldest_first.begin(), oldest_first.end(), [&frame](std::size_t a, std::size_t b) {
    return frame.lines[a].age > frame.lines[b].age;
  });
  for (const std::size_t i : oldest_first) {
    write(std::to_string(frame.lines[i].id), curves[i], cv::Scalar::all(255));
  }
}

std::vector<TrackPainter::Loss> TrackPainter::follow(const LineFrame& frame) {
  const bool is_next = frame.epoch == epoch_ && frame.image_count == image_count_ + 1;
  if (frame.epoch != epoch_) trails_.clear();
  epoch_ = frame.epoch;
  image_count_ = frame.image_count;
  ++paintings_;
  for (const TrackedLine& line : frame.lines) {
    Trail& trail = trails_[line.id];
    trail.painted = paintings_;
    trail.segments.push_back(line.segment);
    if (trail.segments.size() > style_.trail_images + 1) trail.segments.pop_front();
  }
  std::vector<Loss> losses;
  for (auto trail = trails_.begin(); trail != trails_.end();) {
    const bool is_lost = trail->second.painted != paintings_;
    if (is_lost && is_next) {
      const LineCurve line = lens_.curve(trail->second.segments.back());
      losses.push_back({trail->first, line, reasonOf(trail->first, frame.lost)});
    }
    trail = is_lost ? trails_.erase(trail) : std::next(trail);
  }
  const auto length = [](const Loss& loss) { return clampOrLow(loss.line.chord.length(), 0.0F, 1e6F); };
  std::sort(losses.begin(), losses.end(), [&length](const Loss& a, const Loss& b) {
    return length(a) != length(b) ? length(a) > length(b) : a.id < b.id;
  });
  return losses;
}

void TrackPainter::drawTrail(const Trail& trail, const cv::Scalar& colour, cv::Mat& bgr) const {
  for (std::size_t i = 1; i < trail.segments.size(); ++i) {
    const double freshness = static_cast<double>(i) / static_cast<double>(trail.segments.size());
    const cv::Scalar faded = colour * (0.3 + 0.6 * freshness);
    const LineSegment& from = trail.segments[i - 1];
    const LineSegment& to = trail.segments[i];
    cv::line(bgr, fixedPoint(from.start), fixedPoint(to.start), faded, drawingThickness(1, bgr), cv::LINE_AA,
             kDrawingShift);
    cv::line(bgr, fixedPoint(from.end), fixedPoint(to.end), faded, drawingThickness(1, bgr), cv::LINE_AA,
             kDrawingShift);
  }
}

}  // namespace tet_line_tracker
