// The inner loops, written once on vectors of eight and compiled for each instruction set (kernels_*.cpp). No
// inline function of another header may be used here: the linker would keep one copy of it, perhaps the one
// this processor cannot run.
#include "float8_inline.h"
#include "gradient_inline.h"
#include "kernels.h"
#include "profile_inline.h"

namespace tet_line_tracker {
namespace kernels {
namespace {

/// 1 for columns inside the patch, 0 outside.
inline __attribute__((always_inline)) Float8 insideColumns(int vector, int side) {
  const Int8 lanes = {0, 1, 2, 3, 4, 5, 6, 7}, none = {0, 0, 0, 0, 0, 0, 0, 0};
  const Mask8 inside = less(lanes + vector * kLanes, none + side);
  const Float8 one = {1, 1, 1, 1, 1, 1, 1, 1};
  return (Float8)((Int8)one & inside);
}

/// Sixteen pixels as 16-bit numbers.
inline __attribute__((always_inline)) Short16 loadShorts(const std::uint8_t* pixels) {
#if defined(__AVX2__)
  return (Short16)_mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels)));
#elif defined(__SSE2__)
  const __m128i zero = _mm_setzero_si128();
  const __m128i bytes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels));
  const __m128i halves[2] = {_mm_unpacklo_epi8(bytes, zero), _mm_unpackhi_epi8(bytes, zero)};
  Short16 vector;
  __builtin_memcpy(&vector, halves, sizeof vector);
  return vector;
#elif defined(__ARM_NEON)
  const uint8x16_t bytes = vld1q_u8(pixels);
  const uint16x8_t halves[2] = {vmovl_u8(vget_low_u8(bytes)), vmovl_u8(vget_high_u8(bytes))};
  Short16 vector;
  __builtin_memcpy(&vector, halves, sizeof vector);
  return vector;
#else
  Byte16 bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  return __builtin_convertvector(bytes, Short16);
#endif
}

#if defined(__ARM_NEON)
/// Eight pixels of the next level from seventeen vertical sums around `sums`.
inline __attribute__((always_inline)) uint8x8_t halveEight(const std::uint16_t* sums) {
  const uint16x8_t left = vld2q_u16(sums - 2).val[1];
  const uint16x8x2_t pair = vld2q_u16(sums);
  return vrshrn_n_u16(vaddq_u16(vaddq_u16(left, pair.val[1]), vshlq_n_u16(pair.val[0], 1)), 4);
}

inline __attribute__((always_inline)) void storeBytes(std::uint8_t* output, uint8x8_t first,
                                                      uint8x8_t second) {
  vst1q_u8(output, vcombine_u8(first, second));
}
#else
/// Stores sixteen numbers of 0..255 as bytes.
inline __attribute__((always_inline)) void storeBytes(std::uint8_t* output, Int8 first, Int8 second) {
#if defined(__SSE2__)
  __m128i quarters[4];
  __builtin_memcpy(quarters, &first, sizeof first);
  __builtin_memcpy(quarters + 2, &second, sizeof second);
  const __m128i bytes =
      _mm_packus_epi16(_mm_packs_epi32(quarters[0], quarters[1]), _mm_packs_epi32(quarters[2], quarters[3]));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(output), bytes);
#else
  std::int32_t numbers[2 * kLanes];
  __builtin_memcpy(numbers, &first, sizeof first);
  __builtin_memcpy(numbers + kLanes, &second, sizeof second);
  for (int i = 0; i < 2 * kLanes; ++i) output[i] = static_cast<std::uint8_t>(numbers[i]);
#endif
}

/// Eight pixels of the next level from seventeen vertical sums around `sums`, as pairs in 32-bit words: the
/// even column in the low half, the odd one in the high half.
inline __attribute__((always_inline)) Int8 halveEight(const std::uint16_t* sums) {
  Int8 left, pair;
  __builtin_memcpy(&left, sums - 2, sizeof left);
  __builtin_memcpy(&pair, sums, sizeof pair);
  const Int8 low = {0xffff, 0xffff, 0xffff, 0xffff, 0xffff, 0xffff, 0xffff, 0xffff};
  return (((left >> 16) & low) + (pair & low) * 2 + ((pair >> 16) & low) + 8) >> 4;
}
#endif

void halveRow(const std::uint8_t* above, const std::uint8_t* middle, const std::uint8_t* below, int width,
              std::uint16_t* row, std::uint8_t* output) {
  // row[x + 2] is the vertical sum at x: the left neighbour of column 0 has a place, and one more because
  // halveEight() loads words that begin with it.
  std::uint16_t* sums = row + 2;
  int x = 0;
  for (; x + 16 <= width; x += 16) {
    const Short16 s = loadShorts(above + x) + loadShorts(middle + x) * 2 + loadShorts(below + x);
    __builtin_memcpy(sums + x, &s, sizeof s);
  }
  for (; x < width; ++x) sums[x] = static_cast<std::uint16_t>(above[x] + 2 * middle[x] + below[x]);
  row[0] = row[1] = sums[0];
  sums[width] = sums[width - 1];

  const int half = (width + 1) / 2;
  x = 0;
  for (; x + 16 < half; x += 16) {
    storeBytes(output + x, halveEight(sums + 2 * x), halveEight(sums + 2 * x + 16));
  }
  for (; x < half; ++x) {
    output[x] = static_cast<std::uint8_t>((sums[2 * x - 1] + 2 * sums[2 * x] + sums[2 * x + 1] + 8) >> 4);
  }
}

template <int kVectors>
inline __attribute__((always_inline)) void readRow(const std::uint8_t* pixels, Float8 fraction_x,
                                                   Float8* row) {
  for (int v = 0; v < kVectors; ++v) {
    const Float8 left = loadPixels(pixels + v * kLanes);
    const Float8 right = loadPixels(pixels + v * kLanes + 1);
    row[v] = left + (right - left) * fraction_x;
  }
}

/// A row of a larger patch: gray one pixel right of `pixels`, and its central difference, unscaled.
template <int kVectors>
inline __attribute__((always_inline)) void readRowWithSlope(const std::uint8_t* pixels, Float8 fraction_x,
                                                            Float8* gray, Float8* slope) {
  for (int v = 0; v < kVectors; ++v) {
    const std::uint8_t* p = pixels + v * kLanes;
    const Float8 a = loadPixels(p), b = loadPixels(p + 1), c = loadPixels(p + 2), d = loadPixels(p + 3);
    gray[v] = b + (c - b) * fraction_x;
    slope[v] = (c - a) + ((d - b) - (c - a)) * fraction_x;
  }
}

template <int kVectors, bool kProject>
void makeTemplateOf(const PatchPlace& place, const PatchShape& shape, PatchTemplate* patch) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  const float pixels = static_cast<float>(shape.side * shape.side);
  Float8 inside[kVectors];
  for (int v = 0; v < kVectors; ++v) inside[v] = insideColumns(v, shape.side);
  // Sums are taken about some gray value of the patch: small numbers keep their digits.
  const auto first = static_cast<float>(place.data[place.stride + 1]);
  const Float8 origin = broadcast(first);
  const Float8 fraction_x = broadcast(place.fraction_x), fraction_y = broadcast(place.fraction_y);
  const Float8 half = broadcast(0.5F);

  Float8 g = zero, x = zero, y = zero, gg = zero, gx = zero, gy = zero, xx = zero, xy = zero, yy = zero;
  // Rows above, at and below the one that is written, and the image row that follows.
  Float8 above[kVectors], here[kVectors], slope_here[kVectors], gray[kVectors], slope[kVectors];
  Float8 next_gray[kVectors], next_slope[kVectors];
  readRowWithSlope<kVectors>(place.data, fraction_x, gray, slope);
  readRowWithSlope<kVectors>(place.data + place.stride, fraction_x, next_gray, next_slope);
  for (int v = 0; v < kVectors; ++v) {
    above[v] = gray[v] + (next_gray[v] - gray[v]) * fraction_y;
    gray[v] = next_gray[v];
    slope[v] = next_slope[v];
  }
  readRowWithSlope<kVectors>(place.data + 2 * place.stride, fraction_x, next_gray, next_slope);
  for (int v = 0; v < kVectors; ++v) {
    here[v] = gray[v] + (next_gray[v] - gray[v]) * fraction_y;
    slope_here[v] = slope[v] + (next_slope[v] - slope[v]) * fraction_y;
    gray[v] = next_gray[v];
    slope[v] = next_slope[v];
  }
  for (int row = 0; row < shape.side; ++row) {
    readRowWithSlope<kVectors>(place.data + (row + 3) * place.stride, fraction_x, next_gray, next_slope);
    for (int v = 0; v < kVectors; ++v) {
      const Float8 below = gray[v] + (next_gray[v] - gray[v]) * fraction_y;
      const Float8 a = (here[v] - origin) * inside[v];
      const Float8 b = slope_here[v] * half * inside[v];
      const Float8 c = (below - above[v]) * half * inside[v];
      const int i = (row * kVectors + v) * kLanes;
      store(patch->gray + i, a);
      store(patch->gradient_x + i, b);
      store(patch->gradient_y + i, c);
      g += a;
      gg += a * a;
      if (kProject) {
        x += b;
        y += c;
        gx += a * b;
        gy += a * c;
      }
      xx += b * b;
      xy += b * c;
      yy += c * c;
      above[v] = here[v];
      here[v] = below;
      slope_here[v] = slope[v] + (next_slope[v] - slope[v]) * fraction_y;
      gray[v] = next_gray[v];
      slope[v] = next_slope[v];
    }
  }
  const float g_sum = sum(g);
  const float mean = g_sum / pixels;
  patch->mean = first + mean;
  patch->gray_gray = sum(gg) - g_sum * mean;
  patch->xx = sum(xx);
  patch->xy = sum(xy);
  patch->yy = sum(yy);
  float x_mean = 0.0F, y_mean = 0.0F, x_gain = 0.0F, y_gain = 0.0F;
  if (kProject) {
    x_mean = sum(x) / pixels;
    y_mean = sum(y) / pixels;
    const float gray_x = sum(gx) - sum(x) * mean;
    const float gray_y = sum(gy) - sum(y) * mean;
    const float floor = 1e-3F * pixels;  // a patch without contrast has no gain to take out
    if (patch->gray_gray > floor) {
      x_gain = gray_x / patch->gray_gray;
      y_gain = gray_y / patch->gray_gray;
    }
    patch->xx -= sum(x) * x_mean + x_gain * gray_x;
    patch->xy -= sum(x) * y_mean + x_gain * gray_y;
    patch->yy -= sum(y) * y_mean + y_gain * gray_y;
  }
  const Float8 gray_mean = broadcast(mean), x_means = broadcast(x_mean), y_means = broadcast(y_mean);
  const Float8 x_gains = broadcast(x_gain), y_gains = broadcast(y_gain);
  for (int row = 0; row < shape.side; ++row) {
    for (int v = 0; v < kVectors; ++v) {
      const int i = (row * kVectors + v) * kLanes;
      const Float8 a = (load(patch->gray + i) - gray_mean) * inside[v];
      store(patch->gray + i, a);
      if (!kProject) continue;
      store(patch->gradient_x + i, (load(patch->gradient_x + i) - x_means - a * x_gains) * inside[v]);
      store(patch->gradient_y + i, (load(patch->gradient_y + i) - y_means - a * y_gains) * inside[v]);
    }
  }
}

template <int kVectors>
void makeTemplateOf(const PatchPlace& place, const PatchShape& shape, bool project, PatchTemplate* patch) {
  if (project) {
    makeTemplateOf<kVectors, true>(place, shape, patch);
  } else {
    makeTemplateOf<kVectors, false>(place, shape, patch);
  }
}

void makeTemplate(const PatchPlace& place, const PatchShape& shape, bool project, PatchTemplate* patch) {
  switch (shape.vectors) {
    case 1:
      return makeTemplateOf<1>(place, shape, project, patch);
    case 2:
      return makeTemplateOf<2>(place, shape, project, patch);
    default:
      return makeTemplateOf<3>(place, shape, project, patch);
  }
}

/// The rows of a patch of the second image, less the template's mean, as take(y * kVectors + v, vector).
template <int kVectors, typename Take>
inline __attribute__((always_inline)) void readPatch(const PatchPlace& place, int side, float mean,
                                                     const Take& take) {
  const Float8 fraction_x = broadcast(place.fraction_x), fraction_y = broadcast(place.fraction_y);
  const Float8 means = broadcast(mean);
  Float8 upper[kVectors], lower[kVectors];
  readRow<kVectors>(place.data, fraction_x, upper);
  for (int y = 0; y < side; ++y) {
    readRow<kVectors>(place.data + (y + 1) * place.stride, fraction_x, lower);
    for (int v = 0; v < kVectors; ++v) {
      take(y * kVectors + v, upper[v] + (lower[v] - upper[v]) * fraction_y - means);
      upper[v] = lower[v];
    }
  }
}

template <int kVectors>
void alignOf(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference, float* patch,
             AlignmentSums* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 inside[kVectors];
  for (int v = 0; v < kVectors; ++v) inside[v] = insideColumns(v, shape.side);
  Float8 s_i = zero, s_ii = zero, s_ig = zero, s_ix = zero, s_iy = zero;
  readPatch<kVectors>(
      place, shape.side, reference.mean, [&](int vector, Float8 gray) __attribute__((always_inline)) {
        const int k = vector * kLanes;
        const Float8 i = gray * inside[vector % kVectors];
        store(patch + k, i);
        s_i += i;
        s_ii += i * i;
        s_ig += i * load(reference.gray + k);
        s_ix += i * load(reference.gradient_x + k);
        s_iy += i * load(reference.gradient_y + k);
      });
  *sums = {sum(s_i), sum(s_ii), sum(s_ig), sum(s_ix), sum(s_iy)};
}

void align(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference, float* patch,
           AlignmentSums* sums) {
  switch (shape.vectors) {
    case 1:
      return alignOf<1>(place, shape, reference, patch, sums);
    case 2:
      return alignOf<2>(place, shape, reference, patch, sums);
    default:
      return alignOf<3>(place, shape, reference, patch, sums);
  }
}

template <int kVectors>
void subtractOf(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference,
                DifferenceSums* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 inside[kVectors];
  for (int v = 0; v < kVectors; ++v) inside[v] = insideColumns(v, shape.side);
  Float8 s_x = zero, s_y = zero, s_dd = zero, s_abs = zero;
  readPatch<kVectors>(
      place, shape.side, reference.mean, [&](int vector, Float8 gray) __attribute__((always_inline)) {
        const int k = vector * kLanes;
        const Float8 d = (gray - load(reference.gray + k)) * inside[vector % kVectors];
        s_x += d * load(reference.gradient_x + k);
        s_y += d * load(reference.gradient_y + k);
        s_dd += d * d;
        s_abs += absolute(d);
      });
  *sums = {sum(s_x), sum(s_y), sum(s_dd), sum(s_abs)};
}

void subtract(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference,
              DifferenceSums* sums) {
  switch (shape.vectors) {
    case 1:
      return subtractOf<1>(place, shape, reference, sums);
    case 2:
      return subtractOf<2>(place, shape, reference, sums);
    default:
      return subtractOf<3>(place, shape, reference, sums);
  }
}

float absoluteDifference(const float* patch, const PatchShape& shape, const PatchTemplate& reference,
                         float gain, float offset) {
  const Float8 gains = broadcast(gain), offsets = broadcast(offset);
  Float8 total = {0, 0, 0, 0, 0, 0, 0, 0};
  for (int y = 0; y < shape.side; ++y) {
    for (int v = 0; v < shape.vectors; ++v) {
      const int k = (y * shape.vectors + v) * kLanes;
      const Float8 difference = load(patch + k) - load(reference.gray + k) * gains - offsets;
      total += absolute(difference) * insideColumns(v, shape.side);
    }
  }
  return sum(total);
}

constexpr KernelTable makeTable(const char* name) {
  return {name,      halveRow,   makeTemplate, align,       subtract, absoluteDifference,
          findEdges, sumOffsets, sumSupport,   gradientRow, findPeaks};
}

}  // namespace

}  // namespace kernels
}  // namespace tet_line_tracker
