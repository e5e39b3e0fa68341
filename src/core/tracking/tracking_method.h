#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/motion/motion_prior.h"
#include "tet_line_tracker/parameters/parameters.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tracking/checks.h"
#include "tracking/detection_policy.h"
#include "tracking/edge_grower.h"
#include "tracking/track_initializer.h"

namespace tet_line_tracker {

/// The parts of a tracking method. Whoever uses them does not know which method it is.
struct TrackingMethod {
  int pyramid_levels{1};  ///< that the parts want to see
  MotionPriorParameters motion;
  std::unique_ptr<EndpointTracker> flow;
  float dead_band_px{0.0F};  ///< ends stay in place until they have moved this far
  /// A line in the dead band keeps its template unless its residual is above this, 0..1
  float max_kept_residual{0.0F};
  std::unique_ptr<LineRefiner> refiner;  ///< nullptr: lines stay where the flow puts them
  std::optional<EdgeGrower> grower;      ///< nothing: lines never become longer than they were detected
  TrackChecks checks;                    ///< in this order
  std::unique_ptr<DetectionPolicy> detection_policy;
  std::unique_ptr<TrackInitializer> initializer;
  std::vector<std::string> notes;  ///< one sentence for each parameter that is not used as it was given
};

/// The method that `parameters.method` names, made of its parts. Throws std::invalid_argument with every
/// broken rule of check(), or when the detector is not available.
TrackingMethod makeTrackingMethod(const LineTrackerParameters& parameters);

}  // namespace tet_line_tracker
