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

constexpr int kMaxVectors = 3;

/// 1 for columns inside the patch, 0 outside.
inline __attribute__((always_inline)) Float8 insideColumns(int vector, int side) {
  const Int8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  const Mask8 inside = (lanes + vector * kLanes) < side;
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
#else
  Byte16 bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  return __builtin_convertvector(bytes, Short16);
#endif
}

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
  for (int i = 0; i < kLanes; ++i) {
    output[i] = static_cast<std::uint8_t>(first[i]);
    output[i + kLanes] = static_cast<std::uint8_t>(second[i]);
  }
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
    const Int8 totals[2] = {halveEight(sums + 2 * x), halveEight(sums + 2 * x + 16)};
    storeBytes(output + x, totals[0], totals[1]);
  }
  for (; x < half; ++x) {
    output[x] = static_cast<std::uint8_t>((sums[2 * x - 1] + 2 * sums[2 * x] + sums[2 * x + 1] + 8) >> 4);
  }
}

template <int kVectors>
inline __attribute__((always_inline)) void readRow(const std::uint8_t* pixels, float fraction_x,
                                                   Float8* row) {
  for (int v = 0; v < kVectors; ++v) {
    const Float8 left = loadPixels(pixels + v * kLanes);
    const Float8 right = loadPixels(pixels + v * kLanes + 1);
    row[v] = left + (right - left) * fraction_x;
  }
}

template <int kVectors>
void readPatchOf(const PatchPlace& place, const PatchShape& shape, float* output) {
  Float8 upper[kVectors], lower[kVectors];
  readRow<kVectors>(place.data, place.fraction_x, upper);
  for (int y = 0; y < shape.side; ++y) {
    readRow<kVectors>(place.data + (y + 1) * place.stride, place.fraction_x, lower);
    for (int v = 0; v < kVectors; ++v) {
      store(output + (y * kVectors + v) * kLanes, upper[v] + (lower[v] - upper[v]) * place.fraction_y);
      upper[v] = lower[v];
    }
  }
}

void readPatch(const PatchPlace& place, const PatchShape& shape, float* output) {
  switch (shape.vectors) {
    case 1:
      return readPatchOf<1>(place, shape, output);
    case 2:
      return readPatchOf<2>(place, shape, output);
    default:
      return readPatchOf<3>(place, shape, output);
  }
}

void makeTemplate(const float* larger_patch, const PatchShape& shape, bool project, PatchTemplate* patch) {
  const int larger_row = PatchShape::ofSide(shape.side + 2).vectors * kLanes;
  const int row = shape.vectors * kLanes;
  const float pixels = static_cast<float>(shape.side * shape.side);
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 inside[kMaxVectors];
  for (int v = 0; v < shape.vectors; ++v) inside[v] = insideColumns(v, shape.side);

  Float8 gray_sum = zero, x_sum = zero, y_sum = zero;
  for (int y = 0; y < shape.side; ++y) {
    for (int v = 0; v < shape.vectors; ++v) {
      const float* here = larger_patch + (y + 1) * larger_row + v * kLanes + 1;
      const Float8 gray = load(here) * inside[v];
      const Float8 x = (load(here + 1) - load(here - 1)) * 0.5F * inside[v];
      const Float8 y_gradient = (load(here + larger_row) - load(here - larger_row)) * 0.5F * inside[v];
      const int i = y * row + v * kLanes;
      store(patch->gray + i, gray);
      store(patch->gradient_x + i, x);
      store(patch->gradient_y + i, y_gradient);
      gray_sum += gray;
      x_sum += x;
      y_sum += y_gradient;
    }
  }
  patch->mean = sum(gray_sum) / pixels;
  const float x_mean = project ? sum(x_sum) / pixels : 0.0F;
  const float y_mean = project ? sum(y_sum) / pixels : 0.0F;

  Float8 gg = zero, gx = zero, gy = zero;
  for (int y = 0; y < shape.side; ++y) {
    for (int v = 0; v < shape.vectors; ++v) {
      const int i = y * row + v * kLanes;
      const Float8 gray = (load(patch->gray + i) - patch->mean) * inside[v];
      const Float8 x = (load(patch->gradient_x + i) - x_mean) * inside[v];
      const Float8 y_gradient = (load(patch->gradient_y + i) - y_mean) * inside[v];
      store(patch->gray + i, gray);
      store(patch->gradient_x + i, x);
      store(patch->gradient_y + i, y_gradient);
      gg += gray * gray;
      gx += gray * x;
      gy += gray * y_gradient;
    }
  }
  patch->gray_gray = sum(gg);
  patch->gray_x = sum(gx);
  patch->gray_y = sum(gy);
  const float floor = 1e-3F * pixels;  // a patch without contrast has no gain to take out
  const float x_gain = project && patch->gray_gray > floor ? patch->gray_x / patch->gray_gray : 0.0F;
  const float y_gain = project && patch->gray_gray > floor ? patch->gray_y / patch->gray_gray : 0.0F;

  Float8 xx = zero, xy = zero, yy = zero;
  for (int i = 0; i < shape.floats(); i += kLanes) {
    const Float8 gray = load(patch->gray + i);
    const Float8 x = load(patch->gradient_x + i) - gray * x_gain;
    const Float8 y = load(patch->gradient_y + i) - gray * y_gain;
    store(patch->gradient_x + i, x);
    store(patch->gradient_y + i, y);
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  patch->xx = sum(xx);
  patch->xy = sum(xy);
  patch->yy = sum(yy);
  if (project) patch->gray_x = patch->gray_y = 0.0F;
}

template <int kVectors>
void alignOf(const PatchPlace& place, const PatchShape& shape, const PatchTemplate& reference, float* patch,
             AlignmentSums* sums) {
  const Float8 zero = {0, 0, 0, 0, 0, 0, 0, 0};
  Float8 inside[kVectors];
  for (int v = 0; v < kVectors; ++v) inside[v] = insideColumns(v, shape.side);
  Float8 s_i = zero, s_ii = zero, s_ig = zero, s_ix = zero, s_iy = zero;
  Float8 upper[kVectors], lower[kVectors];
  readRow<kVectors>(place.data, place.fraction_x, upper);
  for (int y = 0; y < shape.side; ++y) {
    readRow<kVectors>(place.data + (y + 1) * place.stride, place.fraction_x, lower);
    for (int v = 0; v < kVectors; ++v) {
      const int k = (y * kVectors + v) * kLanes;
      const Float8 i = (upper[v] + (lower[v] - upper[v]) * place.fraction_y - reference.mean) * inside[v];
      upper[v] = lower[v];
      store(patch + k, i);
      s_i += i;
      s_ii += i * i;
      s_ig += i * load(reference.gray + k);
      s_ix += i * load(reference.gradient_x + k);
      s_iy += i * load(reference.gradient_y + k);
    }
  }
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

float absoluteDifference(const float* patch, const PatchShape& shape, const PatchTemplate& reference,
                         float gain, float offset) {
  Float8 total = {0, 0, 0, 0, 0, 0, 0, 0};
  for (int y = 0; y < shape.side; ++y) {
    for (int v = 0; v < shape.vectors; ++v) {
      const int k = (y * shape.vectors + v) * kLanes;
      const Float8 difference = load(patch + k) - load(reference.gray + k) * gain - offset;
      total += absolute(difference) * insideColumns(v, shape.side);
    }
  }
  return sum(total);
}

constexpr KernelTable makeTable(const char* name) {
  return {name,      halveRow,   readPatch,   makeTemplate, align, absoluteDifference,
          findEdges, sumOffsets, gradientRow, findPeaks};
}

}  // namespace

}  // namespace kernels
}  // namespace tet_line_tracker
