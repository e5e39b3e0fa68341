#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Age from which on a track has the colour of the oldest [images].
constexpr std::uint32_t kOldestColouredAge = 100;

/// Colour of a track: from red (just detected) over yellow and green to blue (kOldestColouredAge and older),
/// on a logarithmic scale. Red, green, blue, 0..1.
std::array<float, 3> colourOfAge(std::uint32_t age);

/// "support", "edge jump", ...: for legends and diagnostics.
const char* nameOf(LossReason reason);

/// Draws the lines of images over these images: coloured by age, with their ids where there is room, the way
/// their endpoints came, what was lost since the image before and why, and a legend. Keeps the recent
/// endpoints of the lines it has painted.
class TrackPainter {
 public:
  struct Style {
    std::size_t trail_images{12};  ///< endpoints are followed back over so many painted images; 0: no trail
    bool ids{true};    ///< beside the lines, where no line runs and no other id is, oldest tracks first
    bool scale{true};  ///< legend along the lower border: colours of ages, counts, time, reasons of losses
    /// Lines of the image before that are no longer there, dashed where they were, longest first with the
    /// reason where there is room.
    bool lost{true};
  };

  TrackPainter() : TrackPainter(Style{}) {}
  explicit TrackPainter(const Style& style) : style_(style) {}

  /// For the paintings to come.
  void setStyle(const Style& style) { style_ = style; }
  /// Lines are painted as this camera shows them: along the curve into which its lens bends them. nullptr, as
  /// at first: straight.
  void setCamera(std::shared_ptr<const CameraModel> camera);

  /// Paints `frame` over its image `gray` (8-bit, one channel) into `bgr`, which is reallocated unless it is
  /// an 8-bit image of three channels and the same size already. Throws std::invalid_argument when `gray` is
  /// not 8-bit gray or not of the frame's size.
  void paint(const cv::Mat& gray, const LineFrame& frame, cv::Mat& bgr);

 private:
  struct Trail {
    std::deque<LineSegment> segments;  ///< latest last
    std::uint64_t painted{0};          ///< number of the painting that saw the line last
  };

  struct Loss {
    std::uint64_t id;
    LineCurve line;     ///< where it was in the image before
    LossReason reason;  ///< kCount: not known
  };

  /// Gives the lines of the image before that `frame` lacks, longest first; none when that was not the last
  /// one painted.
  std::vector<Loss> follow(const LineFrame& frame);
  void drawLabels(const LineFrame& frame, const std::vector<LineCurve>& curves,
                  const std::vector<Loss>& losses, cv::Mat& bgr) const;
  void drawTrail(const Trail& trail, const cv::Scalar& colour, cv::Mat& bgr) const;

  Style style_;
  std::shared_ptr<const CameraModel> camera_;
  cv::Size lens_size_;  ///< of the images that lens_ is for [px]
  LensBend lens_;       ///< of camera_
  std::uint32_t epoch_{0};
  std::uint64_t image_count_{0};  ///< of the last painted image
  std::uint64_t paintings_{0};
  std::unordered_map<std::uint64_t, Trail> trails_;
};

}  // namespace tet_line_tracker
