#pragma once

#include <cstddef>
#include <cstdint>

namespace tet_line_tracker {
namespace kernels {

/// Extra elements that the row buffer of halveRow needs beyond the row.
constexpr std::size_t kRowPadding = 32;

/// Pixels in one vector of a patch row.
constexpr int kLanes = 8;

/// Components of the gradient at a pixel, 48 per gray level of a step. Side by side, since whoever follows an
/// edge reads both, and waits for memory.
struct Gradient {
  std::int16_t dx;  ///< positive: brighter to the right
  std::int16_t dy;  ///< positive: brighter below
};

/// Lowest bits of a gradient magnitude, left free for flags.
constexpr std::int16_t kFlags = 3;

/// What findPeaks writes.
constexpr std::uint8_t kPeakInRow = 1;
constexpr std::uint8_t kPeakInColumn = 2;

/// The largest patch [px].
constexpr int kMaxPatchSide = 21;

/// A square patch of `side` x `side` pixels, kept as `side` rows of `vectors` * kLanes floats. Columns from
/// `side` on are zero in a template.
struct PatchShape {
  int side;     ///< [px]
  int vectors;  ///< per row: side / kLanes, rounded up

  static constexpr PatchShape ofSide(int side) { return {side, (side + kLanes - 1) / kLanes}; }
  constexpr int floats() const { return side * vectors * kLanes; }
};

/// Where a patch begins in an 8-bit image: its top-left pixel, and the fraction of a pixel right and below
/// it. Reading n rows touches n + 1 rows of the image, and 3 pixels beyond `vectors` * kLanes.
struct PatchPlace {
  const std::uint8_t* data;
  std::ptrdiff_t stride;
  float fraction_x, fraction_y;
};

/// Template of a patch. gray has the mean taken off.
struct PatchTemplate {
  float* gray;
  float* gradient_x;
  float* gradient_y;
  float mean;        ///< of gray before it was taken off
  float gray_gray;   ///< sum of gray^2
  float xx, xy, yy;  ///< sums of products of the gradients
};

/// Sums over a patch of the second image, read at some place; `i` is its gray less the template's mean.
struct AlignmentSums {
  float i;         ///< sum of i
  float i_i;       ///< of i^2
  float i_gray;    ///< of i * gray
  float i_x, i_y;  ///< of i * gradient
};

/// Sums of differences d over a patch: the second image's less the template's gray.
struct DifferenceSums {
  float x, y;      ///< of d * gradient
  float square;    ///< of d^2
  float absolute;  ///< of |d|
};

/// Pixels of the longest profile across a line.
constexpr int kMaxProfile = 19;

/// Eight profiles across a line, along an image axis.
struct ProfileBatch {
  const std::uint8_t* pixels[kLanes];  ///< first pixel of each
  std::ptrdiff_t step;                 ///< from one pixel of a profile to the next
  int count;                           ///< pixels of a profile, 3..kMaxProfile
  float polarity;                      ///< 1: the edge sought rises along the profile, -1: it falls
  float centre[kLanes];                ///< where the line crosses each [px from its first pixel]
  float distance_scale;                ///< turns px along the profile into shares of the reach of the search
  float peak_share;  ///< of the peak's slope: what is less steep does not pull the edge's place
};

/// Where profiles found an edge, as arrays of `count` rounded up to whole vectors; what is beyond has slope
/// -1.
struct EdgeSamples {
  const float* places;   ///< along the line, -1 at its start to 1 at its end
  const float* offsets;  ///< from the line, along its normal [px]
  const float* slopes;   ///< [gray / px]
  const float* widths;   ///< of the edge across the line [px]
  int count;
};

/// Offset of the edge from the line: offset + tilt * place [px].
struct OffsetFit {
  float offset{0.0F};
  float tilt{0.0F};
  float at(float place) const { return offset + tilt * place; }
};

/// The inner loops. Every table gives the same bits: plain IEEE operations on vectors of eight, in the same
/// order.
struct KernelTable {
  const char* name;

  /// One output row of the pyramid from three input rows of `width` pixels. `row`: width + kRowPadding
  /// elements.
  void (*halveRow)(const std::uint8_t* above, const std::uint8_t* middle, const std::uint8_t* below,
                   int width, std::uint16_t* row, std::uint8_t* output);

  /// Makes a template. `place`: of the patch and a rim of one pixel around it, shape.side + 2 a side.
  /// `project`: takes from the gradients what a change of gain and offset would explain.
  void (*makeTemplate)(const PatchPlace& place, const PatchShape& shape, bool project, PatchTemplate* patch);

  /// Sums of a patch of the second image against a template; the patch itself, less the template's mean, goes
  /// to `patch` (shape.floats()).
  void (*align)(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference,
                float* patch, AlignmentSums* sums);

  /// Differences of a patch of the second image from a template, as they are: no gain, no offset.
  void (*subtract)(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference,
                   DifferenceSums* sums);

  /// Sum of |patch - gain * gray - offset| over the patch.
  float (*absoluteDifference)(const float* patch, const PatchShape& shape, const PatchTemplate& reference,
                              float gain, float offset);

  /// Steepest place of each profile, its slope [gray / px], and how wide the edge is: its height over its
  /// steepest difference [px]. Slope 0 where nothing rises as sought.
  void (*findEdges)(const ProfileBatch& batch, float* places, float* slopes, float* widths);

  /// Sums of w, w p, w p^2, w o and w p o over samples at places p with offsets o that are at least
  /// `min_slope` steep; w is Tukey's weight of the distance from `fit`, 0 from `width` [px] on.
  void (*sumOffsets)(const EdgeSamples& samples, const OffsetFit& fit, float width, float min_slope,
                     float* sums);

  /// Number of samples nearer than `reach` [px] to `fit` and at least `min_slope` steep, and the sums of
  /// their slopes, squared distances and widths.
  void (*sumSupport)(const EdgeSamples& samples, const OffsetFit& fit, float reach, float min_slope,
                     float* sums);

  /// One row of the gradient from the five image rows around it: [1 4 6 4 1] along the edge times
  /// [-1 -2 0 2 1] across it, and the sum of the absolute values of both components, whose bits kFlags are
  /// zero. Writes columns 2 to width - 3. `smooth` and `slope`: scratch of `width` elements.
  void (*gradientRow)(const std::uint8_t* const rows[5], int width, std::int16_t* smooth, std::int16_t* slope,
                      Gradient* gradient, std::int16_t* magnitude);

  /// Ridge points of at least `threshold` in one row of `magnitude` (columns 2 to width - 3): kPeakInRow
  /// where the gradient is rather horizontal and the pixel tops its neighbours left and right, kPeakInColumn
  /// where it is rather vertical and tops those above and below, else 0.
  void (*findPeaks)(const std::int16_t* magnitude, std::ptrdiff_t stride, const Gradient* gradient, int width,
                    std::int16_t threshold, std::uint8_t* peaks);
};

/// The fastest table for this processor, chosen at the first call.
const KernelTable& active();

/// All tables that run on this processor, baseline first; `count` receives their number.
const KernelTable* const* available(int* count);

}  // namespace kernels
}  // namespace tet_line_tracker
