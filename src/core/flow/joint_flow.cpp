#include <algorithm>
#include <array>

#include "flow/patch_flow.h"
#include "image/patch_reader.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"

namespace tet_line_tracker {
namespace {

/// The iterations end with a step below these [px of the level]: what is left, the level below finds, and
/// after the finest one the edge re-fit.
constexpr float kCoarseStep = 0.2F;
constexpr float kFineStep = 0.1F;

/// Weight of the prior on the endpoints: where they are expected, as strongly as this much gray noise would
/// blur their place [gray^2 / px^2 per pixel]. It decides only where no texture does, above all along the
/// edge.
constexpr float kPriorWeight = 1.0F;

/// The iterations for one line on one level.
class JointLevel {
 public:
  using Status = EndpointFlow::Status;

  JointLevel(const EndpointTrackerParameters& parameters, const PatchRow& row, const cv::Mat& image)
      : parameters_(parameters),
        row_(row),
        image_(image),
        shape_(kernels::PatchShape::ofSide(parameters.window_px)),
        pixels_(static_cast<float>(shape_.side * shape_.side)),
        max_movement_(kMaxMovement * static_cast<float>(shape_.side)),
        bounds_(ImageBounds::ofImage(image.cols, image.rows)),
        reader_(shape_) {}

  Status track(bool finest, LineCurve& line, float& residual) {
    LineSegment& segment = line.chord;
    const LineSegment expected = segment;
    placePatches(line);
    const float last_step = finest ? kFineStep : kCoarseStep;
    for (int iteration = 1;; ++iteration) {
      if (!matchPatches(segment)) return Status::kOutside;
      if (parameters_.robust_patches) computeGemanMcClureWeights(matches_.data(), count_);
      JointEquations equations;
      for (std::size_t i = 0; i < count_; ++i) equations.add(matches_[i]);
      equations.addPrior(segment, expected, kPriorWeight * pixels_);
      const auto [start_step, end_step] = equations.solve();
      segment.start += start_step;
      segment.end += end_step;
      // Written so that NaN fails.
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
    return residual <= parameters_.max_joint_residual ? Status::kTracked : Status::kHighResidual;
  }

 private:
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

  /// Mean absolute difference of the gray values, with gain and offset matched if so asked [gray].
  float differenceOf(const PatchMatch& match, std::size_t slot) {
    if (!parameters_.gain_and_offset) return match.absolute;
    return kernels_.absoluteDifference(grayOf(slot), shape_, match.patch->reference, match.gain,
                                       match.offset) /
           (pixels_ * match.gain);
  }

  /// From the chord to the curve at each patch. The line turns so little on a level that they stay as they
  /// are.
  void placePatches(const LineCurve& line) {
    for (std::size_t i = 0; i < row_.count; ++i) {
      const float fraction = row_.patches[i].fraction;
      from_chord_[i] = line.at(fraction) - line.chord.at(fraction);
    }
  }

  /// False when no patch is in the image; otherwise the line goes on with those that are.
  bool matchPatches(const LineSegment& segment) {
    count_ = 0;
    for (std::size_t i = 0; i < row_.count; ++i) {
      const Patch& patch = row_.patches[i];
      const Eigen::Vector2f centre = segment.at(patch.fraction) + from_chord_[i];
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
  std::array<Eigen::Vector2f, kMaxPatches> from_chord_;
  std::array<PatchMatch, kMaxPatches> matches_;
  std::size_t count_{0};
  /// Of the patches in the second image, less the means of their templates.
  alignas(32) std::array<float, kMaxPatches* static_cast<std::size_t>(
                                    kernels::PatchShape::ofSide(kernels::kMaxPatchSide).floats())> gray_;
};

class JointFlow : public EndpointTracker {
 public:
  explicit JointFlow(const EndpointTrackerParameters& parameters)
      : EndpointTracker(parameters,
                        {parameters.finest_level, static_cast<std::size_t>(parameters.max_patches),
                         parameters.gain_and_offset}) {}

 private:
  Status trackOnLevel(const PatchRow& row, const cv::Mat& image, bool finest, LineCurve& line,
                      float& residual) const override {
    return JointLevel(parameters(), row, image).track(finest, line, residual);
  }
};

}  // namespace

std::unique_ptr<EndpointTracker> makeJointFlow(const EndpointTrackerParameters& parameters) {
  return std::make_unique<JointFlow>(parameters);
}

}  // namespace tet_line_tracker
