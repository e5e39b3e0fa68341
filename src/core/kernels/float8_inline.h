// Vectors of eight, the words in which the inner loops are written; included by kernels_inline.h, to whose
// rules it keeps.
#include "kernels.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace tet_line_tracker {
namespace kernels {
namespace {

using Float8 = float __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Mask8 = std::int32_t __attribute__((vector_size(32)));
using Short16 = std::uint16_t __attribute__((vector_size(32)));
using Byte8 = std::uint8_t __attribute__((vector_size(8)));
using Byte16 = std::uint8_t __attribute__((vector_size(16)));

/// Eight pixels as floats. Written out for x86, where GCC would move the bytes one by one.
inline __attribute__((always_inline)) Float8 loadPixels(const std::uint8_t* pixels) {
#if defined(__AVX2__)
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(pixels));
  return (Float8)_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes));
#elif defined(__SSE2__)
  const __m128i zero = _mm_setzero_si128();
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(pixels));
  const __m128i shorts = _mm_unpacklo_epi8(bytes, zero);
  const __m128 halves[2] = {_mm_cvtepi32_ps(_mm_unpacklo_epi16(shorts, zero)),
                            _mm_cvtepi32_ps(_mm_unpackhi_epi16(shorts, zero))};
  Float8 vector;
  __builtin_memcpy(&vector, halves, sizeof vector);
  return vector;
#else
  Byte8 bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  return __builtin_convertvector(__builtin_convertvector(bytes, Int8), Float8);
#endif
}

inline __attribute__((always_inline)) Float8 load(const float* values) {
  Float8 vector;
  __builtin_memcpy(&vector, values, sizeof vector);
  return vector;
}

inline __attribute__((always_inline)) void store(float* values, Float8 vector) {
  __builtin_memcpy(values, &vector, sizeof vector);
}

/// a > b, lane by lane. In halves for processors with shorter vectors, where GCC would compare the lanes one
/// by one.
inline __attribute__((always_inline)) Mask8 greater(Float8 a, Float8 b) {
#if defined(__AVX__)
  return a > b;
#else
  Float4 a_halves[2], b_halves[2];
  __builtin_memcpy(a_halves, &a, sizeof a);
  __builtin_memcpy(b_halves, &b, sizeof b);
  const Int4 halves[2] = {a_halves[0] > b_halves[0], a_halves[1] > b_halves[1]};
  Mask8 mask;
  __builtin_memcpy(&mask, halves, sizeof mask);
  return mask;
#endif
}

/// Always in the same order, whatever the instruction set.
inline __attribute__((always_inline)) float sum(Float8 v) {
  Float4 halves[2];
  __builtin_memcpy(halves, &v, sizeof halves);
  const Float4 fours = halves[0] + halves[1];
  const Float4 twos = fours + Float4{fours[2], fours[3], 0.0F, 0.0F};
  return twos[0] + twos[1];
}

inline __attribute__((always_inline)) Float8 absolute(Float8 v) {
  const Int8 all_but_sign = {0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff,
                             0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff};
  return (Float8)((Int8)v & all_but_sign);
}

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
