#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/gradient_image.h"
#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {

/// Our own detector: lines are grown along gradient ridges. From an anchor (a strong local maximum of the
/// gradient on a coarse grid of rows and columns) a straight line is drawn both ways, one pixel of its main
/// axis per step. Each step looks for the ridge next to where the line fitted so far predicts it, takes its
/// place to a fraction of a pixel and updates the fit; short gaps are jumped. Thresholds follow the noise
/// that the image itself shows, so that dim images give their lines and noise gives none. Ideas from edge
/// drawing (Topal and Akinlar, EDLines) and ELSED (Suarez et al.).
class EdgeDetector : public LineDetector {
 public:
  std::string name() const override { return "edge"; }

 private:
  /// The image seen along one axis: `t` counts along the main axis of a line (its steep component), `o`
  /// across it.
  struct Axis {
    std::ptrdiff_t along, across;  ///< index steps
    int size_along, size_across;   ///< [px]
    bool along_x;
  };
  struct Anchor {
    std::uint16_t x, y;
    bool along_x;  ///< the line runs more along x than along y
  };
  /// A ridge point that a line went through.
  struct RidgePoint {
    float t, o;
  };
  /// Line o = mean_o + slope (t - mean_t) + curvature / 2 (t - anchor)^2, fitted by running sums. The
  /// curvature is the lens's.
  struct Fit {
    double n{0}, t{0}, o{0}, tt{0}, to{0};
    float slope{0.0F}, mean_t{0.0F}, mean_o{0.0F};
    float curvature{0.0F}, anchor{0.0F};

    /// The same curvature without points.
    Fit emptied() const {
      Fit fit;
      fit.curvature = curvature;
      fit.anchor = anchor;
      return fit;
    }
    float bend(float along) const { return 0.5F * curvature * (along - anchor) * (along - anchor); }
    float slopeAt(float along) const { return slope + curvature * (along - anchor); }

    void add(const RidgePoint& point) {
      const double straight = static_cast<double>(point.o) - static_cast<double>(bend(point.t));
      n += 1.0;
      t += point.t;
      o += straight;
      tt += static_cast<double>(point.t) * point.t;
      to += static_cast<double>(point.t) * straight;
    }
    /// Solves for the line; `prior_weight` [px^2] draws its slope to `prior_slope` while there are few
    /// points.
    void update(float prior_slope, float prior_weight) {
      const double one_over_n = 1.0 / n;
      const double spread = tt - t * t * one_over_n + prior_weight;
      const double product = to - t * o * one_over_n + static_cast<double>(prior_weight) * prior_slope;
      slope = spread > 0.0 ? static_cast<float>(product / spread) : prior_slope;
      mean_t = static_cast<float>(t * one_over_n);
      mean_o = static_cast<float>(o * one_over_n);
    }
    float at(float along) const { return mean_o + slope * (along - mean_t) + bend(along); }
  };

  void find(const cv::Mat& gray, float min_length, const DetectionHints& hints,
            std::vector<LineSegment>& lines) override;
  Axis axisOf(bool along_x) const;
  void collectAnchors(float min_length, const cv::Mat& mask);
  /// Whether the gradient at points `spacing` apart to both sides of an anchor fits a line with its
  /// direction. Spares drawing lines from most anchors in texture and on curves.
  bool looksStraight(const Axis& axis, int anchor_t, int anchor_o, float sign, float slope,
                     int spacing) const;
  /// Whether the gradient at index `i` points along the normal of a line with `slope`, to the side of `sign`.
  bool alongNormal(const Axis& axis, std::ptrdiff_t i, float sign, float slope) const {
    constexpr float kMaxTurn = 0.5F;  // tangent of the angle between gradient and normal
    const kernels::Gradient gradient = gradient_.gradient()[i];
    const auto along = static_cast<float>(axis.along_x ? gradient.dx : gradient.dy);
    const auto across = static_cast<float>(axis.along_x ? gradient.dy : gradient.dx);
    return std::abs(along + slope * across) <= kMaxTurn * sign * (across - slope * along);
  }
  /// Draws the line through an anchor and appends it when it holds.
  void drawLine(const Anchor& anchor, float min_length, std::vector<LineSegment>& lines);
  void growOneWay(const Axis& axis, int anchor_t, int step, float sign, float prior_slope, Fit& fit);
  /// Takes the place of a line that is known, so that it is not found again.
  void markTracked(const LineCurve& line);
  /// Curvature of a straight edge of space through an anchor [1 / px].
  float lensCurvature(const Axis& axis, float t, float o, float slope) const;
  void markLine(const Axis& axis, const Fit& fit, float begin, float end);
  void markTried(const Axis& axis);

  GradientImage gradient_;
  std::int16_t anchor_threshold_{0};
  std::int16_t ridge_threshold_{0};
  std::vector<std::uint8_t> peaks_, wanted_;  // scratch of one row
  std::vector<Anchor> anchors_;
  std::vector<RidgePoint> points_;
  const LensBend* lens_{nullptr};  ///< of the image at hand
};

}  // namespace tet_line_tracker
