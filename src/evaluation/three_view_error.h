#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "pose_track.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "track_measures.h"

namespace tet_line_tracker {

/// What three views of a line say of each other: the planes of the first and the last meet in a line of
/// space, whose projection is compared with the line of the middle view.
struct ThreeViewError {
  /// Larger distance of the middle line's two ends from the projection, divided by the sensitivity where this
  /// is over 1 [px].
  double error_px;
  /// Largest movement of the projection at these ends when the ends of the last view each move by up to 1 px
  /// across their line; 0.5 for a steady motion.
  double sensitivity;

  static constexpr double kMostSensitive = 5.0;  ///< over this the triple is ill-posed
  bool isIllPosed() const { return !(sensitivity <= kMostSensitive); }
};

/// Of a line in three images whose poses are known. Nothing where the planes give no line, or the lens model
/// cannot project what is compared.
std::optional<ThreeViewError> threeViewError(const CameraModel& camera,
                                             const std::array<Eigen::Isometry3d, 3>& world_from_camera,
                                             const std::array<const TrackedLine*, 3>& lines);

/// Three-view errors of tracks: a judge for sequences with poses and no depth. Shares are 0..1; NaN: not
/// known.
struct ThreeViewMeasures {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::size_t triples{0};   ///< three images of a track in a row, all with poses
  std::size_t left_out{0};  ///< of these, ill-posed ones
  std::size_t refuted{0};   ///< of these, ones with an error of the limit or more
  double inlier_ratio{kUnknown}, tight_inlier_ratio{kUnknown};  ///< of the triples not left out
  double left_out_ratio{kUnknown}, refuted_ratio{kUnknown};     ///< of all triples
  struct Triple {
    std::size_t frame;  ///< index of the first image
    std::uint64_t id;
    double error;  ///< [px]
  };
  std::vector<Triple> judged;  ///< the triples not left out
};

/// `inlier_px`, `tight_inlier_px`: errors below which a triple is right [px].
ThreeViewMeasures measureThreeViews(const std::vector<LineFrame>& frames, const PoseTrack& world_from_camera,
                                    const CameraModel& camera, double inlier_px = 2.0,
                                    double tight_inlier_px = 1.0);

/// Two judges of the same triples: shares of those that are right by three views, and of those both line
/// pairs of which are within `inlier_px` of the exact truth. NaN where no triple is judged by both.
struct TripleAgreement {
  double three_view_ratio{ThreeViewMeasures::kUnknown};
  double exact_ratio{ThreeViewMeasures::kUnknown};
};
TripleAgreement compareJudges(const ThreeViewMeasures& three_view, const std::vector<PairError>& pairs,
                              double inlier_px = 2.0);

}  // namespace tet_line_tracker
