// Inner loops of the edge re-fit: eight profiles at a time, one in each lane; included by kernels_inline.h,
// to whose rules they keep.
#include "kernels.h"

namespace tet_line_tracker {
namespace kernels {
namespace {

/// Where `mask` is set `a`, elsewhere `b`.
template <typename Mask, typename Float>
inline __attribute__((always_inline)) Float choose(Mask mask, Float a, Float b) {
  return (Float)((mask & (Mask)a) | (~mask & (Mask)b));
}

/// The middle of the steep part around `steepest` grows towards one side while the slope stays over `floor`.
/// The slope is that over two differences, which noise does not cut short.
template <int kStep>
inline __attribute__((always_inline)) void growSide(const Wide* differences, int count, Wide steepest,
                                                    Wide floor, Wide* weights, Wide* moment) {
  const Wide zero = {};
  WideMask running = {};
  Wide before = zero;
  Wide place = zero + (kStep > 0 ? 0.0F : static_cast<float>(count - 1));
  for (int i = 0; i < count; ++i, place += static_cast<float>(kStep)) {
    const int k = kStep > 0 ? i : count - 1 - i;
    const WideMask at_steepest = place == steepest;
    const WideMask grown = running & (0.5F * (before + differences[k]) > floor);
    const Wide weight = choose(grown & (differences[k] > zero), differences[k], zero);
    *weights += weight;
    *moment += weight * (place - steepest);
    running = at_steepest | grown;
    before = differences[k];
  }
}

/// findEdges() of kWideLanes profiles from `lane` on, whose pixels are those bytes of `words`.
inline __attribute__((always_inline)) void findWideEdges(const ProfileBatch& batch,
                                                         const std::uint64_t* words, int lane, float* places,
                                                         float* slopes_found, float* widths) {
  const Wide zero = {};
  const auto pixels = [&](int k) __attribute__((always_inline)) {
    return loadWidePixels(reinterpret_cast<const std::uint8_t*>(words + k) + lane);
  };
  Wide differences[kMaxProfile];  // from each pixel to the next
  Wide centre;
  __builtin_memcpy(&centre, batch.centre + lane, sizeof centre);
  Wide best_score = zero;
  Wide peak = zero;
  Wide steepest = zero;  // rise at the peak
  Wide steepest_place = zero;
  Wide here = pixels(1);
  differences[0] = (here - pixels(0)) * batch.polarity;
  Wide place = zero + 1.0F;
  for (int k = 1; k + 1 < batch.count; ++k, place += 1.0F) {
    const Wide after = pixels(k + 1);
    differences[k] = (after - here) * batch.polarity;
    here = after;
    const Wide slope = 0.5F * (differences[k - 1] + differences[k]);
    // Near the line wins over far from it.
    const Wide distance = (place - centre) * batch.distance_scale;
    const Wide score = slope * (1.0F - distance * distance * 0.8F);
    const WideMask better = score > best_score;
    best_score = choose(better, score, best_score);
    peak = choose(better, slope, peak);
    const WideMask later = differences[k] > differences[k - 1];
    steepest = choose(better, choose(later, differences[k], differences[k - 1]), steepest);
    steepest_place = choose(better, choose(later, place, place - 1.0F), steepest_place);
  }
  // Middle of the steep part around the peak: also right where motion blur makes it flat and wide. Of
  // differences from pixel to pixel: slopes over two pixels would push the two edges of a narrow stripe
  // apart, which shows as drift when the camera comes nearer, and pull a sharp edge to the nearest pixel.
  const Wide floor = peak * batch.peak_share;
  Wide weights = steepest;
  Wide moment = zero;
  growSide<1>(differences, batch.count - 1, steepest_place, floor, &weights, &moment);
  growSide<-1>(differences, batch.count - 1, steepest_place, floor, &weights, &moment);
  const WideMask found = peak > zero;
  const Wide middle = steepest_place + 0.5F + moment / choose(found, weights, zero + 1.0F);
  const Wide results[3] = {choose(found, middle, centre), choose(found, peak, zero),
                           weights / choose(found, steepest, zero + 1.0F)};
  __builtin_memcpy(places + lane, &results[0], sizeof(Wide));
  __builtin_memcpy(slopes_found + lane, &results[1], sizeof(Wide));
  __builtin_memcpy(widths + lane, &results[2], sizeof(Wide));
}

/// The pixels `k` of the eight profiles, as the bytes of a word.
inline __attribute__((always_inline)) std::uint64_t gatherPixels(const ProfileBatch& batch, int k) {
  std::uint64_t word = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    word |= static_cast<std::uint64_t>(batch.pixels[lane][k * batch.step]) << (8 * lane);
  }
#if defined(__ARM_NEON)
  // One word at a time: of sixteen GCC would insert every byte into a vector of its own.
  __asm__("" : "+r"(word));
#endif
  return word;
}

#if defined(__ARM_NEON)
/// gatherPixels() of `k` to `k` + 7, of profiles along rows: GCC would widen each byte to a word.
inline __attribute__((always_inline)) void gatherEightPixels(const ProfileBatch& batch, int k,
                                                             std::uint64_t* words) {
  const auto rows = [&](int lane) __attribute__((always_inline)) {
    return vcombine_u8(vld1_u8(batch.pixels[lane] + k), vdup_n_u8(0));
  };
  const uint8x16_t r04 = vzip1q_u8(rows(0), rows(4)), r15 = vzip1q_u8(rows(1), rows(5));
  const uint8x16_t r26 = vzip1q_u8(rows(2), rows(6)), r37 = vzip1q_u8(rows(3), rows(7));
  const uint8x16_t even_low = vzip1q_u8(r04, r26), odd_low = vzip1q_u8(r15, r37);
  const uint8x16_t even_high = vzip2q_u8(r04, r26), odd_high = vzip2q_u8(r15, r37);
  const uint8x16_t pairs[4] = {vzip1q_u8(even_low, odd_low), vzip2q_u8(even_low, odd_low),
                               vzip1q_u8(even_high, odd_high), vzip2q_u8(even_high, odd_high)};
  __builtin_memcpy(words, pairs, sizeof pairs);
}
#endif

void findEdges(const ProfileBatch& batch, float* places, float* slopes_found, float* widths) {
  // A word at a time: eight bytes that were stored one by one are slow to load.
  std::uint64_t words[kMaxProfile];
#if defined(__ARM_NEON)
  if (batch.step == 1 && batch.count >= kLanes) {
    for (int k = 0; k + kLanes < batch.count; k += kLanes) gatherEightPixels(batch, k, words + k);
    // The last eight, of which some may be there already.
    gatherEightPixels(batch, batch.count - kLanes, words + batch.count - kLanes);
  } else
#endif
  {
    for (int k = 0; k < batch.count; ++k) words[k] = gatherPixels(batch, k);
  }
  for (int lane = 0; lane < kLanes; lane += kWideLanes) {
    findWideEdges(batch, words, lane, places, slopes_found, widths);
  }
}

void sumOffsets(const EdgeSamples& samples, const OffsetFit& fit, float width, float min_slope, float* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  const Float8 one = broadcast(1.0F), scale = broadcast(1.0F / width), steep = broadcast(min_slope);
  const Float8 fit_offset = broadcast(fit.offset), fit_tilt = broadcast(fit.tilt);
  Float8 w = zero, wp = zero, wpp = zero, wo = zero, wpo = zero;
  for (int i = 0; i < samples.count; i += kLanes) {
    const Float8 place = load(samples.places + i);
    const Float8 offset = load(samples.offsets + i);
    const Float8 ratio = (offset - fit_offset - place * fit_tilt) * scale;
    const Float8 rest = one - ratio * ratio;
    const Mask8 counted = greater(rest, zero) & atLeast(load(samples.slopes + i), steep);
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
  const Int8 lanes = {0, 1, 2, 3, 4, 5, 6, 7}, none = {0, 0, 0, 0, 0, 0, 0, 0};
  const Float8 one = broadcast(1.0F), near = broadcast(reach), steep = broadcast(min_slope);
  const Float8 fit_offset = broadcast(fit.offset), fit_tilt = broadcast(fit.tilt);
  Float8 count = zero, slopes = zero, squares = zero, widths = zero;
  for (int i = 0; i < samples.count; i += kLanes) {
    const Float8 slope = load(samples.slopes + i);
    const Float8 rest = load(samples.offsets + i) - fit_offset - load(samples.places + i) * fit_tilt;
    const Mask8 counted =
        greater(near, absolute(rest)) & atLeast(slope, steep) & less(lanes, none + (samples.count - i));
    count += choose(counted, one, zero);
    slopes += choose(counted, slope, zero);
    squares += choose(counted, rest * rest, zero);
    widths += choose(counted, load(samples.widths + i), zero);
  }
  sums[0] = sum(count);
  sums[1] = sum(slopes);
  sums[2] = sum(squares);
  sums[3] = sum(widths);
}

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
