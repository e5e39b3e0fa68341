#include <algorithm>

#include "flow/patch_flow.h"
#include "image/patch_reader.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"

namespace tet_line_tracker {
namespace {

/// Below this determinant of the mean gradient matrix [gray^4 / px^4] a patch alone does not fix its place in
/// both directions.
constexpr float kMinDeterminant = 1e-4F;

class TwoEndpointFlow : public EndpointTracker {
 public:
  explicit TwoEndpointFlow(const EndpointTrackerParameters& parameters)
      : EndpointTracker(parameters, {0, 2, false}) {}

 private:
  Status trackOnLevel(const PatchRow& row, const cv::Mat& image, bool, LineCurve& line,
                      float& residual) const override {
    LineSegment& segment = line.chord;
    float start_residual = 0.0F;
    float end_residual = 0.0F;
    const Status start = trackEndpoint(row.patches.front(), image, segment.start, start_residual);
    if (start != Status::kTracked && start != Status::kHighResidual) return start;
    const Status end = trackEndpoint(row.patches[row.count - 1], image, segment.end, end_residual);
    // Both endpoints must satisfy the termination condition.
    residual = std::max(start_residual, end_residual);
    return end == Status::kTracked ? start : end;
  }

  Status trackEndpoint(const Patch& patch, const cv::Mat& image, Eigen::Vector2f& point,
                       float& residual) const {
    const kernels::PatchShape shape = kernels::PatchShape::ofSide(parameters().window_px);
    const float pixels = static_cast<float>(shape.side * shape.side);
    const float max_movement = kMaxMovement * static_cast<float>(shape.side);
    const ImageBounds bounds = ImageBounds::ofImage(image.cols, image.rows);
    PatchReader reader(shape);
    const SymmetricMatrix gradients{patch.reference.xx, patch.reference.xy, patch.reference.yy};
    if (gradients.determinant() <= kMinDeterminant * pixels * pixels) return Status::kNoSolution;
    const SymmetricMatrix inverse = gradients.inverse();
    const Eigen::Vector2f expected = point;
    for (int iteration = 0;; ++iteration) {
      if (!bounds.contains(point)) return Status::kOutside;
      kernels::DifferenceSums sums;
      kernels::active().subtract(reader.patch(image, point), shape, patch.reference, &sums);
      const PatchMatch match = matchOf(patch, sums, pixels);
      residual = match.absolute / kGrayRange;
      const Eigen::Vector2f step = -(inverse * match.slope);
      // The paper ends on a small residual alone, which smooth texture reaches long before the sub-pixel
      // position. A step this small leaves the residual as it is.
      const bool converged = step.norm() < static_cast<float>(parameters().min_step);
      if (converged) point += step;
      if (converged || iteration == parameters().max_iterations) {
        return residual < parameters().max_residual ? Status::kTracked : Status::kHighResidual;
      }
      point += step;
      // Written so that NaN fails.
      if (!((point - expected).norm() <= max_movement)) return Status::kNoSolution;
    }
  }
};

}  // namespace

std::unique_ptr<EndpointTracker> makeTwoEndpointFlow(const EndpointTrackerParameters& parameters) {
  return std::make_unique<TwoEndpointFlow>(parameters);
}

}  // namespace tet_line_tracker
