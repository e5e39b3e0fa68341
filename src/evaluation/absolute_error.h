#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "scene_truth.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// What a line of an image is to the true edges of the simulated world. Distances are signed, across the edge
/// [px]: of the undistorted points from the edge's infinite line on z = 1, times the focal length
/// sqrt(|fx fy|). For equidistant and mei lenses, which look beyond z = 1: in the raw image.
struct EdgeVerdict {
  enum class Kind {
    kJudged,
    kNoEdge,     ///< no visible edge runs along the line
    kAmbiguous,  ///< another edge is so near that the line may show it
  };
  Kind kind{Kind::kNoEdge};
  std::size_t edge{0};  ///< number of the edge; edges of one straight line that touch or overlap are one
  double start_px{0.0}, end_px{0.0}, middle_px{0.0};
};

/// Finds the true edge that a line shows. Const use may be shared between threads.
///
/// No limit here depends on how far the line is off, up to kGatePx: an edge is judged or not by what else is
/// near it, so errors are not clipped below half of kSeparationPx, where a line is nearer to its own edge
/// than to any other.
class EdgeJudge {
 public:
  static constexpr double kGatePx = 5.0;        ///< both ends are nearer to the edge than this
  static constexpr double kSeparationPx = 4.0;  ///< a parallel edge nearer than this to the edge competes

  /// `truth` must outlive this.
  explicit EdgeJudge(const SceneTruth& truth);

  /// One verdict per line, in order. No edge for all where no pose is known.
  std::vector<EdgeVerdict> judge(const LineFrame& frame) const;

 private:
  struct View;
  View viewAt(std::int64_t stamp_ns) const;
  EdgeVerdict judge(const TrackedLine& line, const View& view) const;
  double distance(const Eigen::Vector3d& plane, const Eigen::Vector3d& ray) const;
  bool isSeen(const View& view, std::size_t edge, const Eigen::Vector3d& ray) const;

  const SceneTruth& truth_;
  std::vector<std::size_t> line_of_;  ///< per edge: the infinite straight line that it is a part of
  std::vector<std::size_t> edge_of_;  ///< per edge: the chain of touching edges on one line
  bool on_unit_plane_;
  double focal_px_;
};

/// Absolute errors of lines whose length in the raw image is in one class.
struct AbsoluteErrors {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::size_t lines{0};   ///< in all
  std::size_t judged{0};  ///< of these, with an edge
  std::size_t ambiguous{0};
  double worse_median{kUnknown}, worse_p90{kUnknown};    ///< of the worse end [px]
  double middle_median{kUnknown}, middle_p90{kUnknown};  ///< of the middle [px]
  /// Error of an end over its claimed deviation (covariance_px, else sigma_px), both ends: by their median,
  /// so that 1 is honest, and the root of the mean of squares, which a few wrong lines dominate.
  double normalized{kUnknown}, normalized_rms{kUnknown};
  double normalized_worse{kUnknown};   ///< median of the larger of both; 1.05 when both ends are independent
  double normalized_middle{kUnknown};  ///< as `normalized`, of the middle over sigma_px
};

struct AbsoluteMeasures {
  static constexpr std::array<double, 6> kLengths{
      30.0, 60.0, 100.0, 160.0, 250.0, std::numeric_limits<double>::infinity()};  ///< [px]
  std::array<AbsoluteErrors, kLengths.size() - 1> classes;  ///< from kLengths[i] to kLengths[i + 1]
  AbsoluteErrors all;                                       ///< shorter lines included
  /// Lines per image that show the same edge, mean over the edges that a line shows in the image.
  double tracks_per_edge{AbsoluteErrors::kUnknown};
};

/// Judges all lines. The work is shared between threads; the result does not depend on their number.
AbsoluteMeasures measureAbsolute(const std::vector<LineFrame>& frames, const SceneTruth& truth);

}  // namespace tet_line_tracker
