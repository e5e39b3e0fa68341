#include "tracking/tracking_method.h"

#include <algorithm>
#include <string>
#include <utility>

#include <opencv2/core/version.hpp>

namespace tet_line_tracker {
namespace {

/// What noise moves an end by from image to image [px].
constexpr float kDeadBand = 0.25F;
/// What a template that is some images old may differ by.
constexpr float kKeptResidual = 0.05F;

template <class Check, class... Arguments>
void add(TrackChecks& checks, Arguments&&... arguments) {
  checks.push_back(std::make_unique<Check>(std::forward<Arguments>(arguments)...));
}

/// Algorithm 1 of the paper.
TrackingMethod makePaperMethod(const LineTrackerParameters& p) {
  TrackingMethod method;
  method.motion.prior = "none";
  method.motion.predict_parallax = false;
  method.flow = makeTwoEndpointFlow(p.flow);
  add<EndpointsInImageCheck>(method.checks);
  add<MinLengthCheck>(method.checks, p.detection.min_length);
  add<FieldOfViewCheck>(method.checks, p.detection.min_length);
  add<MaskCheck>(method.checks);
  method.detection_policy = makeMinLinesPolicy(p.detection);
  TrackInitializer::Options options;
  options.fit_edges = false;
  options.grow = false;
  options.spread = false;
  options.detectors = {"lsd", "fld", "edge"};
  options.margin_px = 0.0F;
  method.initializer = std::make_unique<TrackInitializer>(p.detection, LineRefiner(p.refiner), options);
  if (p.detection.detector == "auto" && method.initializer->detectorName() != "lsd") {
    method.notes.push_back("LSD, the detector of the paper, does not work with OpenCV " CV_VERSION
                           ": lines are detected by " +
                           method.initializer->detectorName());
  }
  return method;
}

/// The joint estimate with motion prior and edge re-fit.
TrackingMethod makeJointMethod(const LineTrackerParameters& p) {
  TrackingMethod method;
  method.motion = p.motion;
  EndpointTrackerParameters flow = p.flow;
  if (!p.refiner.refine && flow.finest_level > 0) {
    method.notes.push_back(
        "parameter refine is false: the flow ends at level 0 instead of at finest_level, which is " +
        std::to_string(flow.finest_level));
    flow.finest_level = 0;
  }
  method.flow = makeJointFlow(flow);
  method.dead_band_px = kDeadBand;
  method.max_kept_residual = kKeptResidual;
  add<LengthRatioCheck>(method.checks, p.plausibility.max_length_ratio);
  add<AngleCheck>(method.checks, p.plausibility.max_rotation);
  if (p.refiner.refine) {
    method.refiner = std::make_unique<LineRefiner>(p.refiner);
    method.grower.emplace(*method.refiner);
    add<SupportCheck>(method.checks, p.refiner.min_support);
  }
  add<CutAtBorderCheck>(method.checks, p.detection.min_length);
  add<MinLengthCheck>(method.checks, p.detection.min_length);
  add<FieldOfViewCheck>(method.checks, p.detection.min_length);
  add<MaskCheck>(method.checks);
  if (p.plausibility.check_depth) add<DepthCheck>(method.checks);
  if (p.refiner.refine) add<EdgeJumpCheck>(method.checks, p.plausibility.max_edge_offset);
  add<DuplicateCheck>(method.checks);
  method.detection_policy = makeReplenishPolicy(p.detection);
  TrackInitializer::Options options;
  options.fit_edges = p.refiner.refine;
  options.grow = p.refiner.refine;
  method.initializer = std::make_unique<TrackInitializer>(p.detection, LineRefiner(p.refiner), options);
  return method;
}

}  // namespace

TrackingMethod makeTrackingMethod(const LineTrackerParameters& parameters) {
  checked(parameters);
  TrackingMethod method =
      parameters.method == "paper" ? makePaperMethod(parameters) : makeJointMethod(parameters);
  const int for_prior = method.motion.prior == "none" ? 1 : MotionPrior::kPyramidLevels;
  method.pyramid_levels = std::max(parameters.flow.pyramid_levels, for_prior);
  return method;
}

}  // namespace tet_line_tracker
