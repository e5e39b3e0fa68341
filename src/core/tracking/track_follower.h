#pragma once

#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/motion/motion_prior.h"
#include "tet_line_tracker/tracking/line_frame.h"
#include "tracking/track_table.h"
#include "tracking/tracking_method.h"
#include "tracking/visible_area.h"

namespace tet_line_tracker {

/// Follows one track from the image before into this one: predicts where it is by the motion of the camera
/// and what is known of its depth, searches along what is not known, and lets the flow find it from there.
/// Const: tracks are followed in parallel.
class TrackFollower {
 public:
  /// `pyramid_before`: of the image before; its level 0 is not read.
  TrackFollower(const TrackingMethod& method, const MotionPrior& prior, const VisibleArea& area,
                const ImagePyramid& pyramid_before)
      : method_(method), prior_(prior), area_(area), pyramid_before_(pyramid_before) {}

  /// Moves `line` and sets what `state` knows of the step, or why the track is lost.
  void follow(const MotionPrediction& motion, const ImagePyramid& pyramid, TrackedLine& line,
              TrackState& state) const;
  /// Takes the patches that follow() finds the line by in the next image, where those it has are no longer
  /// good.
  void renewTemplate(const ImagePyramid& pyramid, const TrackedLine& line, TrackState& state) const;

 private:
  EndpointFlow findLine(const MotionPrediction& motion, const ImagePyramid& pyramid, const TrackedLine& line,
                        TrackState& state) const;
  LineBend bendOf(const TrackedLine& line, const TrackState& state) const;
  LineDepth expectDepth(const MotionPrediction& motion, const TrackedLine& line,
                        const TrackState& state) const;
  bool isSure(const MotionPrediction& motion, const LineDepth& depth, const TrackState& state) const;
  LinePath pathOf(const MotionPrediction& motion, const TrackedLine& line, const LineDepth& depth) const;

  const TrackingMethod& method_;
  const MotionPrior& prior_;
  const VisibleArea& area_;
  const ImagePyramid& pyramid_before_;
};

}  // namespace tet_line_tracker
