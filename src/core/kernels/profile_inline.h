// Inner loops of the edge re-fit: eight profiles at a time, one in each lane; included by kernels_inline.h,
// to whose rules they keep.
#include "kernels.h"

namespace tet_line_tracker {
namespace kernels {
namespace {

/// Where `mask` is set `a`, elsewhere `b`.
inline __attribute__((always_inline)) Float8 choose(Mask8 mask, Float8 a, Float8 b) {
  return (Float8)((mask & (Int8)a) | (~mask & (Int8)b));
}

/// The middle of the steep part around `steepest` grows towards one side while the slope stays over `floor`.
/// The slope is that over two differences, which noise does not cut short.
template <int kStep>
inline __attribute__((always_inline)) void growSide(const Float8* differences, int count, Float8 steepest,
                                                    Float8 floor, Float8* weights, Float8* moment) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Mask8 running = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 before = zero;
  for (int i = 0; i < count; ++i) {
    const int k = kStep > 0 ? i : count - 1 - i;
    const Float8 place = zero + static_cast<float>(k);
    const Mask8 at_steepest = place == steepest;
    const Mask8 grown = running & greater(0.5F * (before + differences[k]), floor);
    const Float8 weight = choose(grown & greater(differences[k], zero), differences[k], zero);
    *weights += weight;
    *moment += weight * (place - steepest);
    running = at_steepest | grown;
    before = differences[k];
  }
}

void findEdges(const ProfileBatch& batch, float* places, float* slopes_found) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  // A word at a time: eight bytes that were stored one by one are slow to load.
  std::uint64_t words[kMaxProfile];
  for (int k = 0; k < batch.count; ++k) {
    std::uint64_t word = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      word |= static_cast<std::uint64_t>(batch.pixels[lane][k * batch.step]) << (8 * lane);
    }
    words[k] = word;
  }
  const auto pixels = [&words](int k) {
    return loadPixels(reinterpret_cast<const std::uint8_t*>(words + k));
  };
  Float8 differences[kMaxProfile];  // from each pixel to the next
  const Float8 centre = load(batch.centre);
  Float8 best_score = zero;
  Float8 peak = zero;
  Float8 steepest = zero;  // rise at the peak
  Float8 steepest_place = zero;
  Float8 here = pixels(1);
  differences[0] = (here - pixels(0)) * batch.polarity;
  for (int k = 1; k + 1 < batch.count; ++k) {
    const Float8 after = pixels(k + 1);
    differences[k] = (after - here) * batch.polarity;
    here = after;
    const Float8 slope = 0.5F * (differences[k - 1] + differences[k]);
    // Near the line wins over far from it.
    const Float8 distance = (static_cast<float>(k) - centre) * batch.distance_scale;
    const Float8 score = slope * (1.0F - distance * distance * 0.8F);
    const Mask8 better = greater(score, best_score);
    best_score = choose(better, score, best_score);
    peak = choose(better, slope, peak);
    const Mask8 later = greater(differences[k], differences[k - 1]);
    steepest = choose(better, choose(later, differences[k], differences[k - 1]), steepest);
    const Float8 place = zero + static_cast<float>(k);
    steepest_place = choose(better, choose(later, place, place - 1.0F), steepest_place);
  }
  // Middle of the steep part around the peak: also right where motion blur makes it flat and wide. Of
  // differences from pixel to pixel: slopes over two pixels would push the two edges of a narrow stripe
  // apart, which shows as drift when the camera comes nearer, and pull a sharp edge to the nearest pixel.
  const Float8 floor = peak * batch.peak_share;
  Float8 weights = steepest;
  Float8 moment = zero;
  growSide<1>(differences, batch.count - 1, steepest_place, floor, &weights, &moment);
  growSide<-1>(differences, batch.count - 1, steepest_place, floor, &weights, &moment);
  const Mask8 found = greater(peak, zero);
  const Float8 middle = steepest_place + 0.5F + moment / choose(found, weights, zero + 1.0F);
  store(places, choose(found, middle, centre));
  store(slopes_found, choose(found, peak, zero));
}

void sumOffsets(const EdgeSamples& samples, const OffsetFit& fit, float width, float min_slope, float* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 w = zero, wp = zero, wpp = zero, wo = zero, wpo = zero;
  for (int i = 0; i < samples.count; i += kLanes) {
    const Float8 place = load(samples.places + i);
    const Float8 offset = load(samples.offsets + i);
    const Float8 ratio = (offset - fit.offset - place * fit.tilt) * (1.0F / width);
    const Float8 rest = 1.0F - ratio * ratio;
    const Mask8 counted = (rest > zero) & (load(samples.slopes + i) >= zero + min_slope);
    const Float8 weight = choose(counted, rest * rest, zero);
    w += weight;
    wp += weight * place;
    wpp += weight * place * place;
    wo += weight * offset;
    wpo += weight * place * offset;
  }
  sums[0] = sum(w);
  sums[1] = sum(wp);
  sums[2] = sum(wpp);
  sums[3] = sum(wo);
  sums[4] = sum(wpo);
}

void sumSupport(const EdgeSamples& samples, const OffsetFit& fit, float reach, float min_slope, float* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  const Int8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  Float8 count = zero, slopes = zero, squares = zero;
  for (int i = 0; i < samples.count; i += kLanes) {
    const Float8 slope = load(samples.slopes + i);
    const Float8 rest = load(samples.offsets + i) - fit.offset - load(samples.places + i) * fit.tilt;
    const Mask8 counted =
        (absolute(rest) < zero + reach) & (slope >= zero + min_slope) & (lanes < samples.count - i);
    count += choose(counted, zero + 1.0F, zero);
    slopes += choose(counted, slope, zero);
    squares += choose(counted, rest * rest, zero);
  }
  sums[0] = sum(count);
  sums[1] = sum(slopes);
  sums[2] = sum(squares);
}

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
