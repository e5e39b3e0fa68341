#include "detection/edge_detector.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "geometry/clamp.h"
#include "kernels/kernels.h"

namespace tet_line_tracker {

namespace {

/// Distance of the rows and columns that are searched for anchors [px]: several on every line.
int anchorSpacing(float min_length) {
  return std::clamp(static_cast<int>(min_length / 6.0F), 2, 5);
}

// Threshold of an anchor's magnitude in standard deviations of one gradient component under noise alone.
constexpr float kAnchorSigmas = 4.0F;
// It is also a step in parts of the mean gray level: weaker edges are shading, and come and go. The bounds
// keep out the steps of one that whole gray levels make of smooth shading, and let edges of 10 in.
constexpr float kAnchorContrast = 0.10F;
constexpr float kMinStep = 1.5F;  // [gray levels]
constexpr float kMaxStep = 9.5F;  // [gray levels]
// What an anchor may ask at its place, a line need not hold everywhere.
constexpr float kRidgeShare = 0.6F;

constexpr float kMaxResidual = 1.0F;   // of a ridge point from the predicted line [px]
constexpr float kPriorWeight = 20.0F;  // of the anchor's direction in the fit [px^2]
constexpr float kMinDensity = 0.7F;    // ridge points per pixel of the main axis
constexpr float kMaxSpread = 0.5F;     // standard deviation of the ridge points about their line [px]
constexpr int kMinGap = 2;             // [px]
constexpr int kMaxGap = 8;             // [px]
constexpr int kHitsPerGapPixel = 8;    // a line must be long to jump far

constexpr std::size_t kPasses = 8;  // through the anchors

// Marks in the gradient magnitude.
constexpr std::int16_t kTaken = 1;  // a line lies here
constexpr std::int16_t kTried = 2;  // an anchor here leads to nothing new
static_assert((kTaken | kTried) == kernels::kFlags);

/// Of an anchor's gradient magnitude.
std::int16_t anchorThreshold(const ImageLevels& levels) {
  const float step = std::clamp(kAnchorContrast * levels.gray, kMinStep, kMaxStep);
  const float value =
      std::max(kAnchorSigmas * levels.noise, step * static_cast<float>(GradientImage::kPerGrayLevel));
  return static_cast<std::int16_t>(std::min(value, 32767.0F));
}

}  // namespace

EdgeDetector::Axis EdgeDetector::axisOf(bool along_x) const {
  const std::ptrdiff_t stride = gradient_.stride();
  return along_x ? Axis{1, stride, gradient_.width(), gradient_.height(), true}
                 : Axis{stride, 1, gradient_.height(), gradient_.width(), false};
}

void EdgeDetector::collectAnchors(float min_length, const cv::Mat& mask) {
  anchors_.clear();
  const auto findPeaks = kernels::active().findPeaks;
  const int spacing = anchorSpacing(min_length);
  const std::ptrdiff_t stride = gradient_.stride();
  const int end_x = gradient_.width() - GradientImage::kBorder;
  const int end_y = gradient_.height() - GradientImage::kBorder;
  // Both ends of the row stay zero, and so does the padding that makes whole words of it.
  constexpr int kWord = 8;
  peaks_.assign(static_cast<std::size_t>(gradient_.width()) + kWord, 0);
  wanted_.assign(peaks_.size(), 0);
  for (std::size_t x = 0; x < wanted_.size(); x += static_cast<std::size_t>(spacing)) {
    wanted_[x] = kernels::kPeakInColumn;
  }
  for (int y = GradientImage::kBorder; y < end_y; ++y) {
    const std::ptrdiff_t row = y * stride;
    findPeaks(gradient_.magnitude() + row, stride, gradient_.gradient() + row, gradient_.width(),
              anchor_threshold_, peaks_.data());
    const std::uint64_t in_row = y % spacing == 0 ? 0x0101010101010101ULL * kernels::kPeakInRow : 0;
    for (int word_x = 0; word_x < end_x; word_x += kWord) {
      std::uint64_t peaks, wanted;
      std::memcpy(&peaks, peaks_.data() + word_x, sizeof peaks);
      std::memcpy(&wanted, wanted_.data() + word_x, sizeof wanted);
      if ((peaks & (wanted | in_row)) == 0) continue;
      for (int x = word_x; x < word_x + kWord; ++x) {
        const int peak = peaks_[static_cast<std::size_t>(x)] &
                         (wanted_[static_cast<std::size_t>(x)] | static_cast<std::uint8_t>(in_row));
        if (peak == 0 || (!mask.empty() && mask.at<uchar>(y, x) == 0)) continue;
        anchors_.push_back(
            {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), peak == kernels::kPeakInColumn});
      }
    }
  }
}

bool EdgeDetector::looksStraight(const Axis& axis, int anchor_t, int anchor_o, float sign, float slope,
                                 int spacing) const {
  constexpr int kSteps = 3;  // to each side; as many must hold in all
  int held = 0;
  for (const int direction : {1, -1}) {
    for (int step = 1; step <= kSteps; ++step) {
      const int ahead = direction * step * spacing;
      const int t = anchor_t + ahead;
      const int o = anchor_o + cvRound(slope * static_cast<float>(ahead));
      if (t < 0 || t >= axis.size_along || o < 0 || o >= axis.size_across) break;
      const std::ptrdiff_t i = t * axis.along + o * axis.across;
      if (gradient_.magnitude()[i] < ridge_threshold_ || !alongNormal(axis, i, sign, slope)) break;
      if (++held == kSteps) return true;
    }
  }
  return false;
}

void EdgeDetector::growOneWay(const Axis& axis, int anchor_t, int step, float sign, float prior_slope,
                              Fit& fit) {
  const std::int16_t* magnitude = gradient_.magnitude();
  const int first = GradientImage::kBorder;
  int misses = 0;
  int gap = 0;
  int hits_since_gap = 0;
  std::size_t next_update = 0;
  std::size_t committed = points_.size();
  for (int t = anchor_t + step; t >= first && t < axis.size_along - first; t += step) {
    const float predicted = fit.at(static_cast<float>(t));
    // Written so that NaN fails, and before the cast, so that a steep fit does.
    if (!(predicted >= static_cast<float>(first) && predicted < static_cast<float>(axis.size_across))) break;
    const int o = cvRound(predicted);
    if (o >= axis.size_across - first) break;
    std::ptrdiff_t i = t * axis.along + o * axis.across;
    int peak = o;
    // The highest of the three pixels next to the prediction, if it is a ridge.
    if (magnitude[i + axis.across] > magnitude[i]) {
      i += axis.across;
      ++peak;
    } else if (magnitude[i - axis.across] > magnitude[i]) {
      i -= axis.across;
      --peak;
    }
    const int m = magnitude[i];
    bool hit = false;
    float place = 0.0F;
    if (m >= ridge_threshold_ && (m & kTaken) == 0) {
      const int before = magnitude[i - axis.across];
      const int after = magnitude[i + axis.across];
      if (m >= before && m >= after) {
        const int bend = 2 * m - before - after;
        place = static_cast<float>(peak) +
                (bend > 0 ? 0.5F * static_cast<float>(after - before) / static_cast<float>(bend) : 0.0F);
        hit = std::abs(place - predicted) <= kMaxResidual &&
              alongNormal(axis, i, sign, fit.slopeAt(static_cast<float>(t)));
      }
    }
    if (!hit) {
      const int limit = std::min(kMaxGap, kMinGap + static_cast<int>(points_.size()) / kHitsPerGapPixel);
      if (++misses > limit) break;
      gap = std::max(gap, misses);
      hits_since_gap = 0;
      continue;
    }
    misses = 0;
    points_.push_back({static_cast<float>(t), place});
    fit.add(points_.back());
    if (points_.size() >= next_update) {
      fit.update(prior_slope, kPriorWeight);
      next_update = points_.size() + points_.size() / 4;
    }
    // What lies behind a gap belongs to the line only if there is more of it than there was gap.
    if (++hits_since_gap >= 2 * gap) {
      gap = 0;
      committed = points_.size();
    }
  }
  if (committed < points_.size()) {
    points_.resize(committed);
    fit = fit.emptied();
    for (const RidgePoint& point : points_) fit.add(point);
  }
  fit.update(prior_slope, kPriorWeight);
}

void EdgeDetector::markLine(const Axis& axis, const Fit& fit, float begin, float end) {
  for (int t = static_cast<int>(begin); t <= static_cast<int>(end); ++t) {
    const int o =
        cvRound(clampOrLow(fit.at(static_cast<float>(t)), 1.0F, static_cast<float>(axis.size_across - 2)));
    const std::ptrdiff_t i = t * axis.along + o * axis.across;
    for (const std::ptrdiff_t k : {i - axis.across, i, i + axis.across}) {
      gradient_.magnitude()[k] |= kTaken | kTried;
    }
  }
}

void EdgeDetector::markTracked(const LineCurve& line) {
  // A curve in pieces that are straight to a pixel.
  const int pieces = line.bend.isStraight() ? 1 : 4;
  for (int piece = 0; piece < pieces; ++piece) {
    const Eigen::Vector2f start = line.at(static_cast<float>(piece) / static_cast<float>(pieces));
    const Eigen::Vector2f end = line.at(static_cast<float>(piece + 1) / static_cast<float>(pieces));
    const Eigen::Vector2f way = end - start;
    const bool along_x = std::abs(way.x()) >= std::abs(way.y());
    const Axis axis = axisOf(along_x);
    const Eigen::Vector2f middle = 0.5F * (start + end);
    Fit fit;
    fit.slope = along_x ? way.y() / way.x() : way.x() / way.y();
    fit.mean_t = along_x ? middle.x() : middle.y();
    fit.mean_o = along_x ? middle.y() : middle.x();
    const float half = 0.5F * std::abs(along_x ? way.x() : way.y());
    const auto last = static_cast<float>(axis.size_along - 1);
    markLine(axis, fit, clampOrLow(fit.mean_t - half, 0.0F, last), clampOrLow(fit.mean_t + half, 0.0F, last));
  }
}

float EdgeDetector::lensCurvature(const Axis& axis, float t, float o, float slope) const {
  if (lens_ == nullptr || lens_->isStraight()) return 0.0F;
  // From the sagitta of a piece that lies in the image.
  constexpr float kReach = 50.0F;
  const auto last = static_cast<float>(axis.size_along - 1);
  const float begin = std::max(t - kReach, 0.0F);
  const float end = std::min(t + kReach, last);
  const auto point = [&](float at) -> Eigen::Vector2f {
    const float beside = o + slope * (at - t);
    return axis.along_x ? Eigen::Vector2f(at, beside) : Eigen::Vector2f(beside, at);
  };
  const LineSegment piece{point(begin), point(end)};
  const float sagitta = lens_->between(piece).offset(0.5F);
  const float normal_across = axis.along_x ? piece.normal().y() : piece.normal().x();
  return -8.0F * sagitta / (normal_across * (end - begin) * (end - begin));
}

void EdgeDetector::markTried(const Axis& axis) {
  for (const RidgePoint& point : points_) {
    const int o = cvRound(point.o);
    const std::ptrdiff_t i = static_cast<int>(point.t) * axis.along + o * axis.across;
    gradient_.magnitude()[i] |= kTried;
  }
}

void EdgeDetector::drawLine(const Anchor& anchor, float min_length, std::vector<LineSegment>& lines) {
  const std::ptrdiff_t at_anchor = anchor.y * gradient_.stride() + anchor.x;
  if ((gradient_.magnitude()[at_anchor] & kTried) != 0) return;

  const Axis axis = axisOf(anchor.along_x);
  const int anchor_t = anchor.along_x ? anchor.x : anchor.y;
  const int anchor_o = anchor.along_x ? anchor.y : anchor.x;
  const kernels::Gradient gradient = gradient_.gradient()[at_anchor];
  const float across = anchor.along_x ? gradient.dy : gradient.dx;
  const float along = anchor.along_x ? gradient.dx : gradient.dy;
  const float sign = across > 0.0F ? 1.0F : -1.0F;
  const float prior_slope = -along / across;
  if (!looksStraight(axis, anchor_t, anchor_o, sign, prior_slope, anchorSpacing(min_length))) return;

  points_.clear();
  points_.push_back({static_cast<float>(anchor_t), static_cast<float>(anchor_o)});
  Fit fit;
  fit.anchor = static_cast<float>(anchor_t);
  fit.curvature = lensCurvature(axis, fit.anchor, static_cast<float>(anchor_o), prior_slope);
  fit.add(points_.back());
  fit.update(prior_slope, kPriorWeight);
  growOneWay(axis, anchor_t, 1, sign, prior_slope, fit);
  growOneWay(axis, anchor_t, -1, sign, prior_slope, fit);

  // The anchor itself is in by whole pixels: replace it by the final fit over the others.
  const auto [first, last] = std::minmax_element(points_.begin(), points_.end(),
                                                 [](const auto& a, const auto& b) { return a.t < b.t; });
  const float begin = first->t;
  const float end = last->t;
  const float length = (end - begin) * std::sqrt(1.0F + fit.slope * fit.slope);
  const auto steps = end - begin + 1.0F;
  bool holds = length >= min_length && static_cast<float>(points_.size()) >= kMinDensity * steps;
  if (holds) {
    Fit exact = fit.emptied();
    for (std::size_t k = 1; k < points_.size(); ++k) exact.add(points_[k]);
    exact.update(0.0F, 0.0F);
    double squares = 0.0;
    for (std::size_t k = 1; k < points_.size(); ++k) {
      const float r = points_[k].o - exact.at(points_[k].t);
      squares += static_cast<double>(r) * r;
    }
    fit = exact;
    holds = squares <= static_cast<double>(kMaxSpread * kMaxSpread) * exact.n;
  }
  if (!holds) {
    markTried(axis);
    return;
  }
  markLine(axis, fit, begin, end);
  const auto point = [&axis, &fit](float t) -> Eigen::Vector2f {
    return axis.along_x ? Eigen::Vector2f(t, fit.at(t)) : Eigen::Vector2f(fit.at(t), t);
  };
  LineSegment line{point(begin), point(end)};
  const Eigen::Vector2f brighter = axis.along_x ? Eigen::Vector2f(0.0F, sign) : Eigen::Vector2f(sign, 0.0F);
  if (line.normal().dot(brighter) < 0.0F) std::swap(line.start, line.end);
  lines.push_back(line);
}

void EdgeDetector::find(const cv::Mat& gray, float min_length, const DetectionHints& hints,
                        std::vector<LineSegment>& lines) {
  if (std::min(gray.cols, gray.rows) < GradientImage::kMinSide) return;
  gradient_.compute(gray);
  anchor_threshold_ = anchorThreshold(gradient_.levels(gray));
  ridge_threshold_ = static_cast<std::int16_t>(kRidgeShare * static_cast<float>(anchor_threshold_));
  lens_ = hints.lens;
  for (const LineCurve& line : hints.tracked) markTracked(line);
  collectAnchors(min_length, hints.mask);
  // Spread over the image and over the lines in every pass: long lines, which have many anchors, come early.
  for (std::size_t pass = 0; pass < kPasses; ++pass) {
    for (std::size_t i = pass; i < anchors_.size(); i += kPasses) {
      if (lines.size() >= hints.enough) return;
      drawLine(anchors_[i], min_length, lines);
    }
  }
}

}  // namespace tet_line_tracker
