#include "tet_line_tracker/display/track_painter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

/// Fractional bits of the drawing functions of OpenCV, so that lines lie where they were measured.
constexpr int kShift = 4;

cv::Point fixedPoint(const Eigen::Vector2f& point) {
  constexpr float kScale = 1 << kShift;
  constexpr float kFarOutside = 1e6F;
  return {cvRound(clampOrLow(point.x() * kScale, -kFarOutside, kFarOutside)),
          cvRound(clampOrLow(point.y() * kScale, -kFarOutside, kFarOutside))};
}

cv::Scalar bgrOfAge(std::uint32_t age) {
  const std::array<float, 3> rgb = colourOfAge(age);
  return {255.0 * rgb[2], 255.0 * rgb[1], 255.0 * rgb[0]};
}

/// Thickness and text grow with the picture: 1 at the width of a VGA image.
double drawingScale(const cv::Mat& image) {
  return std::clamp(image.cols / 752.0, 0.5, 4.0);
}

int thickness(double pixels_at_vga, const cv::Mat& image) {
  return std::max(1, cvRound(pixels_at_vga * drawingScale(image)));
}

/// Text with a dark rim, readable on any ground.
void drawText(const std::string& text, cv::Point origin, double size, const cv::Scalar& colour,
              cv::Mat& bgr) {
  const double scale = size * drawingScale(bgr);
  cv::putText(bgr, text, origin, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(0), thickness(2.5, bgr),
              cv::LINE_AA);
  cv::putText(bgr, text, origin, cv::FONT_HERSHEY_SIMPLEX, scale, colour, thickness(1, bgr), cv::LINE_AA);
}

/// The line as pieces so short that the curve leaves them by less than a fixed-point step.
std::vector<cv::Point> pointsOf(const LineCurve& line) {
  constexpr float kPiece = 8.0F;  // [px]
  const float length = line.bend.isStraight() ? 0.0F : line.chord.length();
  const int pieces = 1 + static_cast<int>(clampOrLow(length / kPiece, 0.0F, 1e3F));
  std::vector<cv::Point> points{fixedPoint(line.chord.start)};
  for (int i = 1; i < pieces; ++i) {
    points.push_back(fixedPoint(line.at(static_cast<float>(i) / static_cast<float>(pieces))));
  }
  points.push_back(fixedPoint(line.chord.end));
  return points;
}

void drawLine(const LineCurve& line, const cv::Scalar& colour, cv::Mat& bgr) {
  const std::vector<cv::Point> points = pointsOf(line);
  cv::polylines(bgr, points, false, cv::Scalar::all(20), thickness(3.2, bgr), cv::LINE_AA, kShift);
  cv::polylines(bgr, points, false, colour, thickness(1.6, bgr), cv::LINE_AA, kShift);
  const cv::Point& start = points.front();
  const cv::Point& end = points.back();
  // A full dot at the start and a ring at the end: the roles of the endpoints can be seen to stay.
  const int radius = cvRound(2.4 * drawingScale(bgr) * (1 << kShift));
  cv::circle(bgr, start, radius, colour, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(bgr, end, radius, cv::Scalar::all(20), cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(bgr, end, radius, colour, thickness(1, bgr), cv::LINE_AA, kShift);
}

/// Beside the middle of the line, on its left.
void drawId(std::uint64_t id, const LineCurve& line, const cv::Scalar& colour, cv::Mat& bgr) {
  const std::string text = std::to_string(id);
  const double size = 0.33;
  const cv::Size extent =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size * drawingScale(bgr), 1, nullptr);
  const float away = 0.5F * std::hypot(static_cast<float>(extent.width), static_cast<float>(extent.height)) +
                     3.0F * static_cast<float>(drawingScale(bgr));
  const Eigen::Vector2f centre = line.at(0.5F) + away * line.chord.normal();
  drawText(text,
           {cvRound(clampOrLow(centre.x(), -1e6F, 1e6F)) - extent.width / 2,
            cvRound(clampOrLow(centre.y(), -1e6F, 1e6F)) + extent.height / 2},
           size, colour, bgr);
}

/// Colours with their ages, and what the image holds, along the lower border.
void drawScale(const LineFrame& frame, cv::Mat& bgr) {
  const double scale = drawingScale(bgr);
  const int height = cvRound(22 * scale);
  if (bgr.rows < 4 * height || bgr.cols < cvRound(300 * scale)) return;
  cv::Mat strip = bgr.rowRange(bgr.rows - height, bgr.rows);
  strip.convertTo(strip, -1, 0.25);

  const int left = cvRound(10 * scale);
  const int bar_width = cvRound(150 * scale);
  const int bar_top = cvRound(3 * scale);
  const int bar_bottom = cvRound(8 * scale);
  for (int x = 0; x < bar_width; ++x) {
    const double age = std::pow(static_cast<double>(kOldestColouredAge), x / (bar_width - 1.0));
    cv::line(strip, {left + x, bar_top}, {left + x, bar_bottom},
             bgrOfAge(static_cast<std::uint32_t>(std::lround(age))));
  }
  for (const std::uint32_t age : {1U, 3U, 10U, 30U, kOldestColouredAge}) {
    const int x = cvRound(bar_width * std::log(age) / std::log(kOldestColouredAge));
    drawText(std::to_string(age), {left + x - cvRound(4 * scale), height - cvRound(3 * scale)}, 0.32,
             cv::Scalar::all(235), strip);
  }
  char text[96];
  std::snprintf(text, sizeof(text), "age [images]    %zu lines    image %llu    epoch %u%s",
                frame.lines.size(), static_cast<unsigned long long>(frame.image_count), frame.epoch,
                frame.detected ? "    detected" : "");
  drawText(text, {left + bar_width + cvRound(22 * scale), height - cvRound(7 * scale)}, 0.4,
           cv::Scalar::all(235), strip);
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
  follow(frame);
  if (lens_size_ != gray.size()) lens_ = LensBend(camera_, gray.cols, gray.rows);
  lens_size_ = gray.size();
  for (const TrackedLine& line : frame.lines) {
    const auto trail = trails_.find(line.id);
    if (trail != trails_.end()) drawTrail(trail->second, bgrOfAge(line.age), bgr);
  }
  for (const TrackedLine& line : frame.lines) {
    drawLine(lens_.curve(line.segment), bgrOfAge(line.age), bgr);
  }
  if (style_.ids) {
    for (const TrackedLine& line : frame.lines) {
      drawId(line.id, lens_.curve(line.segment), cv::Scalar::all(255), bgr);
    }
  }
  if (style_.scale) drawScale(frame, bgr);
}

void TrackPainter::follow(const LineFrame& frame) {
  if (style_.trail_images == 0) return;
  if (frame.epoch != epoch_) trails_.clear();
  epoch_ = frame.epoch;
  ++paintings_;
  for (const TrackedLine& line : frame.lines) {
    Trail& trail = trails_[line.id];
    trail.painted = paintings_;
    trail.segments.push_back(line.segment);
    if (trail.segments.size() > style_.trail_images + 1) trail.segments.pop_front();
  }
  for (auto trail = trails_.begin(); trail != trails_.end();) {
    trail = trail->second.painted == paintings_ ? std::next(trail) : trails_.erase(trail);
  }
}

void TrackPainter::drawTrail(const Trail& trail, const cv::Scalar& colour, cv::Mat& bgr) const {
  for (std::size_t i = 1; i < trail.segments.size(); ++i) {
    const double freshness = static_cast<double>(i) / static_cast<double>(trail.segments.size());
    const cv::Scalar faded = colour * (0.3 + 0.6 * freshness);
    const LineSegment& from = trail.segments[i - 1];
    const LineSegment& to = trail.segments[i];
    cv::line(bgr, fixedPoint(from.start), fixedPoint(to.start), faded, thickness(1, bgr), cv::LINE_AA,
             kShift);
    cv::line(bgr, fixedPoint(from.end), fixedPoint(to.end), faded, thickness(1, bgr), cv::LINE_AA, kShift);
  }
}

}  // namespace tet_line_tracker
