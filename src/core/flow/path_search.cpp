#include "flow/path_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/patch_reader.h"

namespace tet_line_tracker {
namespace {

constexpr float kGrayNoise = 9.0F;         ///< variance of the gray values that any picture has [gray^2]
constexpr float kOutsideCost = 0.6F;       ///< of a patch outside the image, which says nothing
constexpr float kTiltCost = 0.002F;        ///< per step between the ends: lines are rather alike in depth
constexpr float kUnexpectedCost = 0.002F;  ///< per step from the expected one
constexpr std::size_t kApart = 2;          ///< steps between two places that are tried [steps]

using StepCosts = std::array<float, LinePath::kMaxSteps>;

/// Share of a patch's contrast that does not fit at each step, 0..1; weight: how much the patch tells.
struct PatchCosts {
  StepCosts costs;
  float fraction;
};

struct Place {
  float cost;
  std::size_t start, end;
};

}  // namespace

std::size_t searchPath(const PatchRow& row, const kernels::PatchShape& shape, const cv::Mat& image,
                       float scale, const LinePath& path,
                       std::array<LineSegment, EndpointTracker::kMaxStarts>& best) {
  const auto pixels = static_cast<float>(shape.side * shape.side);
  const ImageBounds bounds = ImageBounds::ofImage(image.cols, image.rows);
  PatchReader reader(shape);
  alignas(32)
      std::array<float,
                 static_cast<std::size_t>(kernels::PatchShape::ofSide(kernels::kMaxPatchSide).floats())>
          gray;
  std::array<PatchCosts, kMaxPatches> patches;
  float weights = 0.0F;
  for (std::size_t i = 0; i < row.count; ++i) {
    const Patch& patch = row.patches[i];
    const float variance = patch.reference.gray_gray / pixels;
    const float weight = variance / (variance + 4.0F * kGrayNoise);
    weights += weight;
    patches[i].fraction = patch.fraction;
    for (std::size_t k = 0; k < path.count; ++k) {
      const Eigen::Vector2f centre = scale * LineCurve(path.chords[k], path.bend).at(patch.fraction);
      float cost = kOutsideCost;
      if (bounds.contains(centre)) {
        kernels::AlignmentSums sums;
        kernels::active().align(reader.patch(image, centre), shape, patch.reference, gray.data(), &sums);
        cost = std::min(1.0F, matchOf(patch, sums, pixels).square / (variance + kGrayNoise));
      }
      patches[i].costs[k] = weight * cost;
    }
  }
  if (!(weights > 0.0F)) return 0;

  std::array<Place, EndpointTracker::kMaxStarts> places;
  std::size_t found = 0;
  const auto steps = static_cast<float>(path.count);
  for (std::size_t start = 0; start < path.count; ++start) {
    for (std::size_t end = 0; end < path.count; ++end) {
      float sum = 0.0F;
      for (std::size_t i = 0; i < row.count; ++i) {
        const float step = static_cast<float>(start) +
                           patches[i].fraction * (static_cast<float>(end) - static_cast<float>(start));
        const std::size_t lower = std::min(static_cast<std::size_t>(step), path.count - 1);
        const std::size_t upper = std::min(lower + 1, path.count - 1);
        const float between = step - static_cast<float>(lower);
        sum += patches[i].costs[lower] + between * (patches[i].costs[upper] - patches[i].costs[lower]);
      }
      const float tilt = std::abs(static_cast<float>(start) - static_cast<float>(end));
      const float away = std::abs(0.5F * static_cast<float>(start + end) - static_cast<float>(path.expected));
      const Place place{sum / weights + (kTiltCost * tilt + kUnexpectedCost * away) * 32.0F / steps, start,
                        end};
      // Kept sorted; of neighbouring places the better one alone.
      const auto near = [&](const Place& other) {
        return std::max(std::max(other.start, start) - std::min(other.start, start),
                        std::max(other.end, end) - std::min(other.end, end)) < kApart;
      };
      std::size_t slot = 0;
      while (slot < found && places[slot].cost <= place.cost && !near(places[slot])) ++slot;
      if (slot < found && places[slot].cost <= place.cost) continue;  // a better one is near
      // Worse neighbours of this place go.
      std::size_t kept = slot;
      std::array<Place, EndpointTracker::kMaxStarts> rest;
      std::size_t rest_count = 0;
      for (std::size_t k = slot; k < found; ++k) {
        if (!near(places[k])) rest[rest_count++] = places[k];
      }
      if (slot >= places.size()) continue;
      places[kept++] = place;
      for (std::size_t k = 0; k < rest_count && kept < places.size(); ++k) places[kept++] = rest[k];
      found = kept;
    }
  }
  for (std::size_t k = 0; k < found; ++k) {
    best[k] = {path.chords[places[k].start].start, path.chords[places[k].end].end};
  }
  return found;
}

}  // namespace tet_line_tracker
