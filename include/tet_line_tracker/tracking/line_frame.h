#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// An end of a line lies where the image, the mask or the field of view ends, not where its edge does.
enum LineCut : std::uint8_t { kStartCut = 1, kEndCut = 2 };

/// One line of one image. Mirrors Line.msg.
struct TrackedLine {
  std::uint64_t id{0};   ///< the same over the life of the track; never used again by this tracker
  std::uint32_t age{1};  ///< images the track was seen in, this one included
  LineSegment segment;   ///< in the raw image [px]
  Eigen::Vector2d start_normalized{
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< undistorted, z = 1
  Eigen::Vector2d end_normalized{
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< undistorted, z = 1
  /// Standard deviation of the position along the normal, at the middle [px]; NaN: not estimated
  float sigma_px{std::numeric_limits<float>::quiet_NaN()};
  /// Covariance of the distances of start and end across the line: var(start), cov, var(end) [px^2]; NaN: not
  /// estimated
  std::array<float, 3> covariance_px{std::numeric_limits<float>::quiet_NaN(),
                                     std::numeric_limits<float>::quiet_NaN(),
                                     std::numeric_limits<float>::quiet_NaN()};
  std::uint8_t cut{0};  ///< LineCut bits
  /// Mean absolute gray difference between the patches of the image before and their match in this one, after
  /// the flow and before the edge re-fit, 0..1; NaN: detected here
  float residual{std::numeric_limits<float>::quiet_NaN()};

  /// The ends have moved: they are to be normalised again.
  void forgetNormalized() {
    start_normalized.setConstant(std::numeric_limits<double>::quiet_NaN());
    end_normalized = start_normalized;
  }
};

/// Why a track was lost, in the order in which the tracker looks; every lost track has one reason.
enum class LossReason {
  kFlow,         ///< the endpoint flow found no solution: too little texture, or the iterations diverged
  kResidual,     ///< the gray values at the end of the flow do not match
  kLengthRatio,  ///< the length changed by more than max_length_ratio
  kAngle,        ///< the direction changed by more than max_rotation
  kSupport,      ///< less than min_support of the line lies on an edge
  kBorder,       ///< left the image
  kShort,        ///< shorter than min_length
  kFieldOfView,  ///< left the part of the image that can be normalised
  kMask,         ///< entered the masked area
  kDepth,        ///< would lie behind the camera or jump in depth, by how it moved
  kEdgeJump,     ///< its edge lies farther from where the flow ended than is usual in the image
  kDuplicate,    ///< lies on the edge of an older track
  kCount
};

/// A line of the image before that is no longer there.
struct LostLine {
  std::uint64_t id{0};
  LossReason reason{LossReason::kCount};
};

/// What happened to the lines of one image, and how long it took. Mirrors TrackingStatistics.msg.
struct FrameStatistics {
  std::uint32_t tracks_before{0};   ///< lines of the image before
  std::uint32_t tracks_kept{0};     ///< of these, lines that are still there
  std::uint32_t lines_detected{0};  ///< found by the detector on this image
  std::uint32_t lines_added{0};     ///< of these, new tracks
  float coverage{0.0F};             ///< share of the cells of an 8x6 grid that a line crosses, 0..1
  std::uint32_t lines_cut{0};  ///< tracked or detected, cut to the part of the image that can be normalised
  std::uint32_t lines_left_out{0};  ///< the same, but less than min_length was left: lost, or not added
  std::array<std::uint32_t, static_cast<std::size_t>(LossReason::kCount)> lost{};  ///< by LossReason

  std::string prior{"none"};    ///< motion prior that was used
  float prior_rotation{0.0F};   ///< angle of the predicted rotation [rad]
  double imu_time_offset{0.0};  ///< t_imu - t_image in use, given or estimated [s]
  /// How points move in the optical frame by the translation of the camera: unit vector, zero where not known
  std::array<float, 3> translation{};
  std::uint32_t translation_inliers{0};  ///< corners that agree with it

  std::uint32_t dropped_late{0}, dropped_duplicate{0}, dropped_zero{0};  ///< images of this epoch

  /// Of the stages; flow: with template extraction; detect: with the selection of new lines [ms]
  double pyramid_ms{0}, prior_ms{0}, flow_ms{0}, refine_ms{0}, detect_ms{0}, undistort_ms{0}, total_ms{0};

  std::uint32_t& lostFor(LossReason reason) { return lost[static_cast<std::size_t>(reason)]; }
  std::uint32_t lostFor(LossReason reason) const { return lost[static_cast<std::size_t>(reason)]; }
};

/// All lines of one image, oldest id first.
struct LineFrame {
  std::int64_t stamp_ns{0};
  std::uint32_t epoch{0};        ///< +1 at every reset
  std::uint64_t image_count{0};  ///< images accepted in this epoch, this one included
  int width{0}, height{0};       ///< of the image [px]
  bool detected{false};          ///< the detector ran on this image
  std::vector<TrackedLine> lines;
  std::vector<LostLine> lost;  ///< oldest id first; baselines do not fill it
  FrameStatistics statistics;
};

}  // namespace tet_line_tracker
