#include "tet_line_tracker/flow/endpoint_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "flow/patch_flow.h"
#include "image/patch_reader.h"

namespace tet_line_tracker {
namespace {

constexpr float kGrayRange = 255.0F;  // gray thresholds are on [0, 1]

/// Below this determinant of the mean gradient matrix [gray^4 / px^4] an endpoint alone is not fixed in both
/// directions.
constexpr float kMinDeterminant = 1e-4F;

/// The joint estimate ends its iterations with a step below these [px of the level]: what is left, the level
/// below finds, and after the finest one the edge.
constexpr float kCoarseStep = 0.2F;
constexpr float kFineStep = 0.1F;

/// An endpoint that moves alone: the last step on a coarse level, in last steps of the finest one.
constexpr float kCoarseSteps = 20.0F;

/// On one pyramid level, in windows: beyond it nothing in the gradients speaks of the place.
constexpr float kMaxMovement = 1.0F;

/// The joint estimate holds an endpoint where it is expected as strongly as this much gray noise would blur
/// its place [gray^2 / px^2 per pixel]: it decides only where no texture does, above all along the edge.
constexpr float kExpectationWeight = 1.0F;

}  // namespace

struct LineTemplate::Content {
  kernels::PatchShape shape{};
  std::vector<float> pixels;
  std::vector<PatchRow> levels;

  Content(const kernels::PatchShape& patch_shape, std::size_t level_count, std::size_t patches_per_level)
      : shape(patch_shape),
        pixels(level_count * patches_per_level * 3 * static_cast<std::size_t>(patch_shape.floats())),
        levels(level_count) {
    float* next = pixels.data();
    const auto take = [&next, this] {
      float* taken = next;
      next += shape.floats();
      return taken;
    };
    for (PatchRow& level : levels) {
      level.patches.resize(patches_per_level);
      for (Patch& patch : level.patches) {
        patch.reference.gray = take();
        patch.reference.gradient_x = take();
        patch.reference.gradient_y = take();
      }
    }
  }
};

LineTemplate::LineTemplate() = default;
LineTemplate::~LineTemplate() = default;
LineTemplate::LineTemplate(LineTemplate&&) noexcept = default;
LineTemplate& LineTemplate::operator=(LineTemplate&&) noexcept = default;

namespace {

/// The iterations on one pyramid level.
class LevelFlow {
 public:
  using Status = EndpointFlow::Status;

  LevelFlow(const EndpointTrackerParameters& parameters, const PatchRow& row, const cv::Mat& image)
      : parameters_(parameters),
        row_(row),
        image_(image),
        shape_(kernels::PatchShape::ofSide(parameters.window_px)),
        pixels_(static_cast<float>(shape_.side * shape_.side)),
        max_movement_(kMaxMovement * static_cast<float>(shape_.side)),
        bounds_(ImageBounds::ofImage(image.cols, image.rows)),
        reader_(shape_) {}

  /// Moves `segment` [px of the level] from where it is expected to where it is; `residual`: how well the
  /// gray values match on the finest level, on [0, 1].
  Status follow(bool finest, LineSegment& segment, float& residual) {
    if (parameters_.joint_endpoints) return followTogether(finest, segment, residual);
    // The paper: both endpoints must satisfy the termination condition.
    float start_residual = 0.0F;
    float end_residual = 0.0F;
    const float last_step = (finest ? 1.0F : kCoarseSteps) * parameters_.min_step;
    const Status start = followAlone(row_.patches.front(), last_step, segment.start, start_residual);
    if (start != Status::kTracked && start != Status::kHighResidual) return start;
    const Status end = followAlone(row_.patches[row_.count - 1], last_step, segment.end, end_residual);
    residual = std::max(start_residual, end_residual);
    return end == Status::kTracked ? start : end;
  }

 private:
  /// One endpoint by its own patch.
  Status followAlone(const Patch& patch, float last_step, Eigen::Vector2f& point, float& residual) {
    const kernels::PatchTemplate& reference = patch.reference;
    const Symmetric gradients{reference.xx, reference.xy, reference.yy};
    if (gradients.determinant() <= kMinDeterminant * pixels_ * pixels_) return Status::kNoSolution;
    const Symmetric inverse = gradients.inverse();
    const Eigen::Vector2f expected = point;
    for (int iteration = 0;; ++iteration) {
      if (!bounds_.contains(point)) return Status::kOutside;
      const PatchMatch match = matchAt(point, patch, 0);
      residual = differenceOf(match, 0) / kGrayRange;
      const Eigen::Vector2f step = -(inverse * match.slope);
      // The paper ends on a small residual alone, which smooth texture reaches long before the sub-pixel
      // position. A step this small leaves the residual as it is.
      const bool converged = step.norm() < last_step;
      if (converged) point += step;
      if (converged || iteration == parameters_.max_iterations) {
        return residual < parameters_.max_residual ? Status::kTracked : Status::kHighResidual;
      }
      point += step;
      // Written so that it also holds for what is not a number.
      if (!((point - expected).norm() <= max_movement_)) return Status::kNoSolution;
    }
  }

  /// Both endpoints by all patches.
  Status followTogether(bool finest, LineSegment& segment, float& residual) {
    const LineSegment expected = segment;
    const float last_step = finest ? kFineStep : kCoarseStep;
    for (int iteration = 0;; ++iteration) {
      if (!matchPatches(segment)) return Status::kOutside;
      if (parameters_.robust_patches) weigh(matches_.data(), count_);
      JointEquations equations;
      for (std::size_t i = 0; i < count_; ++i) equations.add(matches_[i]);
      equations.hold(segment, expected, kExpectationWeight * pixels_);
      const auto [start_step, end_step] = equations.solve();
      segment.start += start_step;
      segment.end += end_step;
      // Written so that it also holds for what is not a number.
      if (!((segment.start - expected.start).norm() <= max_movement_ &&
            (segment.end - expected.end).norm() <= max_movement_)) {
        return Status::kNoSolution;
      }
      if (iteration == parameters_.max_iterations ||
          (start_step.norm() < last_step && end_step.norm() < last_step)) {
        break;
      }
    }
    if (!finest) return Status::kTracked;
    // Of the place before the last step, which was small.
    residual = meanResidual();
    return residual < parameters_.max_residual ? Status::kTracked : Status::kHighResidual;
  }

  /// `slot`: where the gray values are kept for differenceOf().
  PatchMatch matchAt(const Eigen::Vector2f& centre, const Patch& patch, std::size_t slot) {
    const kernels::PatchPlace place = reader_.patch(image_, centre);
    if (!parameters_.gain_and_offset) {
      kernels::DifferenceSums sums;
      kernels_.subtract(place, shape_, patch.reference, &sums);
      return matchOf(patch, sums, pixels_);
    }
    kernels::AlignmentSums sums;
    kernels_.align(place, shape_, patch.reference, grayOf(slot), &sums);
    return matchOf(patch, sums, pixels_);
  }

  /// Mean absolute difference of the gray values, gain and offset matched if so asked [gray].
  float differenceOf(const PatchMatch& match, std::size_t slot) {
    if (!parameters_.gain_and_offset) return match.absolute;
    return kernels_.absoluteDifference(grayOf(slot), shape_, match.patch->reference, match.gain,
                                       match.offset) /
           (pixels_ * match.gain);
  }

  /// False when nothing of the line is in the image; it goes on with the patches that are.
  bool matchPatches(const LineSegment& segment) {
    count_ = 0;
    for (std::size_t i = 0; i < row_.count; ++i) {
      const Patch& patch = row_.patches[i];
      const Eigen::Vector2f centre = segment.at(patch.fraction);
      if (!bounds_.contains(centre)) continue;
      matches_[count_] = matchAt(centre, patch, count_);
      ++count_;
    }
    return count_ > 0;
  }

  float meanResidual() {
    float sum = 0.0F;
    float weights = 1e-6F;
    for (std::size_t i = 0; i < count_; ++i) {
      sum += matches_[i].weight * differenceOf(matches_[i], i);
      weights += matches_[i].weight;
    }
    return sum / (weights * kGrayRange);
  }

  float* grayOf(std::size_t slot) { return gray_.data() + slot * static_cast<std::size_t>(shape_.floats()); }

  const kernels::KernelTable& kernels_{kernels::active()};
  const EndpointTrackerParameters& parameters_;
  const PatchRow& row_;
  const cv::Mat& image_;
  kernels::PatchShape shape_;
  float pixels_;
  float max_movement_;
  ImageBounds bounds_;
  PatchReader reader_;
  std::array<PatchMatch, kMaxPatches> matches_;
  std::size_t count_{0};
  /// Of the patches in the second image, less the means of their templates.
  alignas(32) std::array<float, kMaxPatches* static_cast<std::size_t>(
                                    kernels::PatchShape::ofSide(kernels::kMaxPatchSide).floats())> gray_;
};

}  // namespace

EndpointTracker::EndpointTracker(const EndpointTrackerParameters& parameters) : parameters_(parameters) {}

void EndpointTracker::describe(const ImagePyramid& first, const LineSegment& segment,
                               LineTemplate& patches) const {
  const kernels::PatchShape shape = kernels::PatchShape::ofSide(parameters_.window_px);
  const std::size_t level_count =
      static_cast<std::size_t>(std::min(first.levels(), parameters_.pyramid_levels));
  const std::size_t capacity =
      parameters_.joint_endpoints ? static_cast<std::size_t>(parameters_.max_patches) : 2;
  if (!patches.content_ || patches.content_->levels.size() != level_count) {
    patches.content_ = std::make_unique<LineTemplate::Content>(shape, level_count, capacity);
  }
  PatchReader reader(shape);
  const std::size_t finest = std::min(level_count - 1, static_cast<std::size_t>(parameters_.finest_level));
  for (std::size_t j = finest; j < level_count; ++j) {
    const float scale = ImagePyramid::scale(static_cast<int>(j));
    PatchRow& row = patches.content_->levels[j];
    const float spacings =
        std::ceil(scale * segment.length() / static_cast<float>(parameters_.patch_spacing));
    row.count = std::clamp(static_cast<std::size_t>(1.0F + spacings), std::size_t{2}, capacity);
    for (std::size_t i = 0; i < row.count; ++i) {
      Patch& patch = row.patches[i];
      patch.fraction = static_cast<float>(i) / static_cast<float>(row.count - 1);
      const Eigen::Vector2f centre = scale * segment.at(patch.fraction);
      kernels::active().makeTemplate(reader.patchWithRim(first.level(static_cast<int>(j)), centre), shape,
                                     parameters_.gain_and_offset, &patch.reference);
    }
  }
}

EndpointFlow EndpointTracker::track(const LineTemplate& patches, const ImagePyramid& second,
                                    const LineSegment& expected) const {
  EndpointFlow flow;
  if (!patches.content_) return flow;
  const LineTemplate::Content& content = *patches.content_;
  flow.segment = expected;
  const int coarsest = std::min(second.levels(), static_cast<int>(content.levels.size())) - 1;
  const int finest = std::min(coarsest, parameters_.finest_level);
  for (int j = coarsest; j >= finest; --j) {
    const float scale = ImagePyramid::scale(j);
    LineSegment at_level{scale * flow.segment.start, scale * flow.segment.end};
    LevelFlow level(parameters_, content.levels[static_cast<std::size_t>(j)], second.level(j));
    flow.status = level.follow(j == finest, at_level, flow.residual);
    const bool poor_but_coarse = flow.status == EndpointFlow::Status::kHighResidual && j > finest;
    if (flow.status != EndpointFlow::Status::kTracked && !poor_but_coarse) return flow;
    flow.segment = {at_level.start / scale, at_level.end / scale};
  }
  return flow;
}

}  // namespace tet_line_tracker
