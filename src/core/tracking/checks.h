#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/segment_index.h"
#include "tet_line_tracker/parameters/parameters.h"
#include "tracking/track_table.h"
#include "tracking/visible_area.h"

namespace tet_line_tracker {

/// One reason for which tracks are lost. Applied to all tracks of an image after flow and re-fit, in the
/// order of LossReason. Not thread-safe: buffers are kept from image to image.
class TrackCheck {
 public:
  explicit TrackCheck(LossReason reason) : reason_(reason) {}
  virtual ~TrackCheck() = default;

  LossReason reason() const { return reason_; }

  /// Marks the tracks that fail as lost for reason(); may cut those that pass. Tracks that are lost already
  /// are left alone.
  virtual void apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) = 0;

 private:
  LossReason reason_;
};

/// A check that looks at one track at a time.
class SingleTrackCheck : public TrackCheck {
 public:
  using TrackCheck::TrackCheck;
  void apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) final;

 private:
  virtual bool passes(const VisibleArea& area, TrackedLine& line, TrackState& state,
                      FrameStatistics& statistics) const = 0;
};

using TrackChecks = std::vector<std::unique_ptr<TrackCheck>>;

/// The length of the followed line against the predicted one.
class LengthRatioCheck : public SingleTrackCheck {
 public:
  explicit LengthRatioCheck(double max_ratio)
      : SingleTrackCheck(LossReason::kLengthRatio), max_ratio_(static_cast<float>(max_ratio)) {}

 private:
  bool passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const override;
  float max_ratio_;
};

/// The direction of the followed line against the predicted one.
class AngleCheck : public SingleTrackCheck {
 public:
  explicit AngleCheck(double max_rotation)
      : SingleTrackCheck(LossReason::kAngle), max_rotation_(max_rotation) {}

 private:
  bool passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const override;
  double max_rotation_;  ///< [rad]
};

/// An edge must lie under the line.
class SupportCheck : public SingleTrackCheck {
 public:
  explicit SupportCheck(double min_support)
      : SingleTrackCheck(LossReason::kSupport), min_support_(min_support) {}

 private:
  bool passes(const VisibleArea&, TrackedLine&, TrackState& state, FrameStatistics&) const override;
  double min_support_;
};

/// Both endpoints must lie in the image.
class EndpointsInImageCheck : public SingleTrackCheck {
 public:
  EndpointsInImageCheck() : SingleTrackCheck(LossReason::kBorder) {}

 private:
  bool passes(const VisibleArea& area, TrackedLine& line, TrackState&, FrameStatistics&) const override;
};

/// Cuts lines at the border of the image; lost when that leaves too little.
class CutAtBorderCheck : public SingleTrackCheck {
 public:
  explicit CutAtBorderCheck(double min_length)
      : SingleTrackCheck(LossReason::kBorder), min_length_(static_cast<float>(min_length)) {}

 private:
  bool passes(const VisibleArea& area, TrackedLine& line, TrackState&, FrameStatistics&) const override;
  float min_length_;  ///< [px]
};

/// Lines must stay long enough.
class MinLengthCheck : public SingleTrackCheck {
 public:
  explicit MinLengthCheck(double min_length)
      : SingleTrackCheck(LossReason::kShort), min_length_(static_cast<float>(min_length)) {}

 private:
  bool passes(const VisibleArea&, TrackedLine& line, TrackState&, FrameStatistics&) const override;
  float min_length_;  ///< [px]
};

/// Cuts lines where pixels can no longer be normalised; lost when that leaves too little.
class FieldOfViewCheck : public SingleTrackCheck {
 public:
  explicit FieldOfViewCheck(double min_length)
      : SingleTrackCheck(LossReason::kFieldOfView), min_length_(static_cast<float>(min_length)) {}

 private:
  bool passes(const VisibleArea& area, TrackedLine& line, TrackState&,
              FrameStatistics& statistics) const override;
  float min_length_;  ///< [px]
};

/// Half of the line at least must lie where the mask lets it.
class MaskCheck : public SingleTrackCheck {
 public:
  MaskCheck() : SingleTrackCheck(LossReason::kMask) {}

 private:
  bool passes(const VisibleArea& area, TrackedLine& line, TrackState&, FrameStatistics&) const override;
};

/// Rejects lines whose movement contradicts their depth, as long as enough corners and most lines agree with
/// the motion of the camera.
class DepthCheck : public TrackCheck {
 public:
  static constexpr std::uint32_t kMinInliers = 20;  ///< a direction from a few corners may be any
  DepthCheck() : TrackCheck(LossReason::kDepth) {}
  void apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) override;
};

/// Rejects lines that jumped to a neighbouring edge: flow and edge disagree by more than is usual for the
/// other lines of the image.
class EdgeJumpCheck : public TrackCheck {
 public:
  explicit EdgeJumpCheck(double max_edge_offset)
      : TrackCheck(LossReason::kEdgeJump), max_edge_offset_(static_cast<float>(max_edge_offset)) {}
  void apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) override;

 private:
  float max_edge_offset_;  ///< [px]
  std::vector<float> offsets_;
};

/// Of two tracks on one edge the older one lives.
class DuplicateCheck : public TrackCheck {
 public:
  DuplicateCheck() : TrackCheck(LossReason::kDuplicate) {}
  void apply(const VisibleArea& area, TrackTable& tracks, FrameStatistics& statistics) override;

 private:
  SegmentIndex older_{DuplicateCriteria{0.05F, 1.5F, 0.3F}};
};

}  // namespace tet_line_tracker
