#include "tracking/tracking_method.h"

namespace tet_line_tracker {
namespace {

/// What noise moves an end by from image to image [px].
constexpr float kDeadBand = 0.25F;

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
  method.initializer = std::make_unique<TrackInitializer>(p.detection, LineRefiner(p.refiner),
                                                          TrackInitializer::Options{false, 0.0F});
  return method;
}

/// The joint estimate with motion prior and edge re-fit.
TrackingMethod makeJointMethod(const LineTrackerParameters& p) {
  TrackingMethod method;
  method.motion = p.motion;
  EndpointTrackerParameters flow = p.flow;
  if (!p.refiner.refine) flow.finest_level = 0;
  method.flow = makeJointFlow(flow);
  method.dead_band_px = kDeadBand;
  add<LengthRatioCheck>(method.checks, p.plausibility.max_length_ratio);
  add<AngleCheck>(method.checks, p.plausibility.max_rotation);
  if (p.refiner.refine) {
    method.refiner = std::make_unique<LineRefiner>(p.refiner);
    add<SupportCheck>(method.checks, p.refiner.min_support);
  }
  add<CutAtBorderCheck>(method.checks, p.detection.min_length);
  add<MinLengthCheck>(method.checks, p.detection.min_length);
  add<FieldOfViewCheck>(method.checks, p.detection.min_length);
  add<MaskCheck>(method.checks);
  if (p.refiner.refine) add<EdgeJumpCheck>(method.checks, p.plausibility.max_edge_offset);
  add<DuplicateCheck>(method.checks);
  method.detection_policy = makeReplenishPolicy(p.detection);
  method.initializer = std::make_unique<TrackInitializer>(p.detection, LineRefiner(p.refiner),
                                                          TrackInitializer::Options{p.refiner.refine, 2.0F});
  return method;
}

}  // namespace

TrackingMethod makeTrackingMethod(const LineTrackerParameters& parameters) {
  checked(parameters);
  return parameters.method == "paper" ? makePaperMethod(parameters) : makeJointMethod(parameters);
}

}  // namespace tet_line_tracker
