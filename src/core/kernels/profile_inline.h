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

/// The middle of the steep part around the peak grows towards one side while the slope stays over `floor`.
template <int kStep>
inline __attribute__((always_inline)) void growSide(const Float8* slopes, int count, Float8 peak_place,
                                                    Float8 floor, Float8* weights, Float8* moment) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Mask8 running = zero > zero;
  for (int i = 1; i + 1 < count; ++i) {
    const int k = kStep > 0 ? i : count - 1 - i;
    const Float8 place = zero + static_cast<float>(k);
    const Float8 weight = slopes[k] - floor;
    const Mask8 at_peak = place == peak_place;
    const Mask8 grown = running & (weight > zero);
    const Float8 counted = choose(grown, weight, zero);
    *weights += counted;
    *moment += counted * (place - peak_place);
    running = at_peak | grown;
  }
}

void findEdges(const ProfileBatch& batch, float* places, float* slopes_found) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  std::uint8_t pixels[kMaxProfile][kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::uint8_t* pixel = batch.pixels[lane];
    for (int k = 0; k < batch.count; ++k) pixels[k][lane] = pixel[k * batch.step];
  }
  Float8 slopes[kMaxProfile];
  const Float8 centre = load(batch.centre);
  Float8 best_score = zero;
  Float8 peak = zero;
  Float8 peak_place = zero;
  Float8 before = loadPixels(pixels[0]);
  Float8 here = loadPixels(pixels[1]);
  for (int k = 1; k + 1 < batch.count; ++k) {
    const Float8 after = loadPixels(pixels[k + 1]);
    slopes[k] = (after - before) * (0.5F * batch.polarity);
    before = here;
    here = after;
    // Near the line wins over far from it.
    const Float8 distance = (static_cast<float>(k) - centre) * batch.distance_scale;
    const Float8 score = slopes[k] * (1.0F - distance * distance * 0.6F);
    const Mask8 better = score > best_score;
    best_score = choose(better, score, best_score);
    peak = choose(better, slopes[k], peak);
    peak_place = choose(better, zero + static_cast<float>(k), peak_place);
  }
  // Middle of the steep part around the peak: also right where motion blur makes it flat and wide.
  const Float8 floor = peak * batch.peak_share;
  Float8 weights = peak - floor;
  Float8 moment = zero;
  growSide<1>(slopes, batch.count, peak_place, floor, &weights, &moment);
  growSide<-1>(slopes, batch.count, peak_place, floor, &weights, &moment);
  const Mask8 found = peak > zero;
  store(places, choose(found, peak_place + moment / choose(found, weights, zero + 1.0F), centre));
  store(slopes_found, choose(found, peak, zero));
}

void sumOffsets(const EdgeSamples& samples, const OffsetFit& fit, float width, float min_slope, float* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 w = zero, wp = zero, wpp = zero, wo = zero, wpo = zero;
  for (int i = 0; i < samples.count; i += kLanes) {
    const Float8 place = load(samples.places + i);
    const Float8 offset = load(samples.offsets + i);
    const Float8 ratio = (offset - fit.offset - place * fit.turn) * (1.0F / width);
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

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
