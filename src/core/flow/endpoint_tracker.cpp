#include "tet_line_tracker/flow/endpoint_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flow/patch_flow.h"
#include "flow/path_search.h"
#include "geometry/clamp.h"
#include "image/patch_reader.h"

namespace tet_line_tracker {

struct LineTemplate::Content {
  kernels::PatchShape shape{};
  std::size_t patches_per_level;
  LineCurve line;                                               ///< that the patches were taken along
  EndpointTracker::Reach reach{EndpointTracker::Reach::kNear};  ///< kNear: the finest level alone is filled
  std::vector<float> pixels;
  std::vector<PatchRow> levels;

  Content(const kernels::PatchShape& patch_shape, std::size_t level_count, std::size_t patch_count)
      : shape(patch_shape),
        patches_per_level(patch_count),
        pixels(level_count * patch_count * 3 * static_cast<std::size_t>(patch_shape.floats())),
        levels(level_count) {
    float* next = pixels.data();
    const auto take = [&next, this] {
      float* taken = next;
      next += shape.floats();
      return taken;
    };
    for (PatchRow& level : levels) {
      level.patches.resize(patch_count);
      for (Patch& patch : level.patches) {
        patch.reference.gray = take();
        patch.reference.gradient_x = take();
        patch.reference.gradient_y = take();
      }
    }
  }

  bool fits(const kernels::PatchShape& patch_shape, std::size_t level_count, std::size_t patch_count) const {
    return shape.side == patch_shape.side && levels.size() == level_count && patches_per_level == patch_count;
  }
};

LineTemplate::LineTemplate() = default;
LineTemplate::~LineTemplate() = default;
LineTemplate::LineTemplate(LineTemplate&&) noexcept = default;
LineTemplate& LineTemplate::operator=(LineTemplate&&) noexcept = default;

EndpointTracker::EndpointTracker(const EndpointTrackerParameters& parameters, const Layout& layout)
    : parameters_(checked(parameters)), layout_(layout) {}

int EndpointTracker::finestLevel(const LineTemplate::Content& content) const {
  return std::min(static_cast<int>(content.levels.size()) - 1, layout_.finest_level);
}

void EndpointTracker::extractTemplate(const ImagePyramid& first, const LineCurve& line, LineTemplate& patches,
                                      Reach reach) const {
  const kernels::PatchShape shape = kernels::PatchShape::ofSide(parameters_.window_px);
  const std::size_t level_count =
      static_cast<std::size_t>(std::min(first.levels(), parameters_.pyramid_levels));
  if (!patches.content_ || !patches.content_->fits(shape, level_count, layout_.max_patches)) {
    patches.content_ = std::make_unique<LineTemplate::Content>(shape, level_count, layout_.max_patches);
  }
  LineTemplate::Content& content = *patches.content_;
  content.line = line;
  content.reach = Reach::kNear;
  extractLevel(first, finestLevel(content), content);
  if (reach == Reach::kFar) extendTemplate(first, patches);
}

void EndpointTracker::extendTemplate(const ImagePyramid& first, LineTemplate& patches) const {
  if (!patches.content_ || patches.content_->reach == Reach::kFar) return;
  LineTemplate::Content& content = *patches.content_;
  for (int j = finestLevel(content) + 1; j < static_cast<int>(content.levels.size()); ++j) {
    extractLevel(first, j, content);
  }
  content.reach = Reach::kFar;
}

void EndpointTracker::extractLevel(const ImagePyramid& first, int level,
                                   LineTemplate::Content& content) const {
  const float scale = ImagePyramid::scale(level);
  PatchReader reader(content.shape);
  PatchRow& row = content.levels[static_cast<std::size_t>(level)];
  const float spacings =
      std::ceil(scale * content.line.chord.length() / static_cast<float>(parameters_.patch_spacing));
  row.count =
      static_cast<std::size_t>(clampOrLow(1.0F + spacings, 2.0F, static_cast<float>(layout_.max_patches)));
  for (std::size_t i = 0; i < row.count; ++i) {
    Patch& patch = row.patches[i];
    patch.fraction = static_cast<float>(i) / static_cast<float>(row.count - 1);
    const Eigen::Vector2f centre = scale * content.line.at(patch.fraction);
    kernels::active().makeTemplate(reader.patchWithRim(first.level(level), centre), content.shape,
                                   layout_.zero_mean, &patch.reference);
  }
}

void EndpointTracker::checkContent(const LineTemplate::Content& content, Reach reach) const {
  if (content.shape.side != parameters_.window_px) {
    throw std::invalid_argument("the template has patches of " + std::to_string(content.shape.side) +
                                " px, the tracker needs window_px " + std::to_string(parameters_.window_px));
  }
  if (reach == Reach::kFar && content.reach == Reach::kNear) {
    throw std::invalid_argument("the template has the finest level only, the tracker needs all: extend it");
  }
}

EndpointFlow EndpointTracker::track(const LineTemplate& patches, const ImagePyramid& second,
                                    const LineCurve& expected, Reach reach) const {
  EndpointFlow flow;
  if (!patches.content_) return flow;
  const LineTemplate::Content& content = *patches.content_;
  checkContent(content, reach);
  flow.segment = expected.chord;
  const int coarsest = std::min(second.levels(), static_cast<int>(content.levels.size())) - 1;
  const int finest = std::min(coarsest, finestLevel(content));
  for (int j = reach == Reach::kNear ? finest : coarsest; j >= finest; --j) {
    const float scale = ImagePyramid::scale(j);
    LineCurve at_level({scale * flow.segment.start, scale * flow.segment.end}, expected.bend);
    for (float& coefficient : at_level.bend.c) coefficient *= scale;
    flow.status = trackOnLevel(content.levels[static_cast<std::size_t>(j)], second.level(j), j == finest,
                               at_level, flow.residual);
    // A coarse level shows little of the texture: its residual decides nothing.
    const bool poor_but_coarse = flow.status == Status::kHighResidual && j > finest;
    if (flow.status != Status::kTracked && !poor_but_coarse) return flow;
    flow.segment = {at_level.chord.start / scale, at_level.chord.end / scale};
  }
  return flow;
}

std::size_t EndpointTracker::search(const LineTemplate& patches, const ImagePyramid& second,
                                    const LinePath& path, std::array<LineSegment, kMaxStarts>& best) const {
  if (!patches.content_ || path.count == 0) return 0;
  const LineTemplate::Content& content = *patches.content_;
  checkContent(content, Reach::kFar);
  const int level = std::min(second.levels(), static_cast<int>(content.levels.size())) - 1;
  return searchPath(content.levels[static_cast<std::size_t>(level)], content.shape, second.level(level),
                    ImagePyramid::scale(level), path, best);
}

}  // namespace tet_line_tracker
