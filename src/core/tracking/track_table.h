#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/geometry/line_bend.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tracking/line_depth.h"

namespace tet_line_tracker {

/// What is known of a track besides what is published.
struct TrackState {
  LineTemplate patches;   ///< what the line looked like at `reference`
  LineSegment reference;  ///< where `patches` were extracted [px]
  LineBend bend;          ///< of the line as it is published, by the lens
  /// `patches` must be extracted again. A line that stands still keeps them, so that slow movement adds up.
  bool template_due{true};
  float contrast{0.0F};  ///< across the edge, positive where the left side is brighter [gray / px]
  /// Movement of the ends beyond the rotation of the camera, predicted for the next image [px]
  Eigen::Vector2f start_parallax{Eigen::Vector2f::Zero()};
  Eigen::Vector2f end_parallax{Eigen::Vector2f::Zero()};
  LineDepth depth;                  ///< of the ends in the last image
  std::array<float, 3> noise_px{};  ///< EdgeFit::noise_px of the line as it was published last [px^2]

  // Of the step from the last image to this one:
  LineSegment rotated;         ///< the line of the last image, moved by the rotation of the camera [px]
  LineSegment predicted;       ///< the same, moved by the predicted parallax as well [px]
  LineStep step;               ///< both images' ends as rays
  LineDepth expected_depth;    ///< of the ends in the image before, in units of 1 / this step
  bool depth_conflict{false};  ///< by how it moved it would lie behind the camera, or its depth jumps
  LineSegment followed;        ///< where the flow found the line [px]
  float edge_offset{0.0F};     ///< of the edge from `followed`, in the middle of what is seen of it [px]
  float support{1.0F};         ///< share of the line that lies on an edge, 0..1
  LossReason loss{LossReason::kCount};  ///< kCount: not lost

  /// The line as it was found in this image has grown along itself from `before` to `after`: its templates
  /// are due, and its parallax is that of the new ends.
  void setGrown(const LineSegment& before, const LineSegment& after);

  bool lost() const { return loss != LossReason::kCount; }
};

/// Why a line is lost with this outcome of its flow; kCount: it is not.
LossReason lossOf(EndpointFlow::Status status);

/// The tracks of an image, oldest first.
class TrackTable {
 public:
  std::size_t size() const { return lines_.size(); }
  TrackedLine& line(std::size_t i) { return lines_[i]; }
  TrackState& state(std::size_t i) { return states_[i]; }
  const std::vector<TrackedLine>& lines() const { return lines_; }
  std::vector<TrackedLine>& lines() { return lines_; }

  /// Starts a track with the next id on an edge; `bend`: of its line, by the lens.
  void add(const EdgeFit& edge, const LineBend& bend);

  /// Moves the lost tracks to the end of `frame.lost` and counts them by reason; the others keep their order.
  void removeLost(LineFrame& frame);

  /// Learns from the step how deep the lines lie. `focal`: [px].
  void measureDepths(const MotionPrediction& motion, double focal);

  /// The movement across a line that the rotation of the camera does not explain will go on in the next
  /// image; along it the flow knows little.
  void predictParallax();
  /// No such movement is predicted.
  void forgetParallax();

  /// Share of the cells of an 8x6 grid over an image of this size [px] that lines cross, 0..1.
  float coverage(const cv::Size& size) const;

  void clear() { lines_.clear(); }

 private:
  std::vector<TrackedLine> lines_;
  /// Of lines_, in their order; more may wait at the end with their buffers.
  std::vector<TrackState> states_;
  std::uint64_t next_id_{0};
};

}  // namespace tet_line_tracker
