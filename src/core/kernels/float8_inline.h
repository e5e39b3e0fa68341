// Vectors of eight, the words in which the inner loops are written; included by kernels_inline.h, to whose
// rules it keeps.
#include "kernels.h"

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

namespace tet_line_tracker {
namespace kernels {
namespace {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
#if defined(__AVX__)
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
#else
/// Eight lanes as two registers, for processors with shorter vectors: GCC keeps a vector that is longer than
/// a register in memory, and takes its lanes one by one where it compares them.
template <typename Half>
struct Halves {
  Half low, high;

  /// The same bits as lanes of another type.
  template <typename Other>
  inline __attribute__((always_inline)) explicit operator Halves<Other>() const {
    return {(Other)low, (Other)high};
  }
};
using Float8 = Halves<Float4>;
using Int8 = Halves<Int4>;

template <typename Half>
inline __attribute__((always_inline)) Halves<Half> operator+(Halves<Half> a, Halves<Half> b) {
  return {a.low + b.low, a.high + b.high};
}
template <typename Half>
inline __attribute__((always_inline)) Halves<Half> operator-(Halves<Half> a, Halves<Half> b) {
  return {a.low - b.low, a.high - b.high};
}
template <typename Half>
inline __attribute__((always_inline)) Halves<Half> operator*(Halves<Half> a, Halves<Half> b) {
  return {a.low * b.low, a.high * b.high};
}
template <typename Half>
inline __attribute__((always_inline)) Halves<Half> operator&(Halves<Half> a, Halves<Half> b) {
  return {a.low & b.low, a.high & b.high};
}
template <typename Half>
inline __attribute__((always_inline)) Halves<Half> operator|(Halves<Half> a, Halves<Half> b) {
  return {a.low | b.low, a.high | b.high};
}
inline __attribute__((always_inline)) Int8 operator+(Int8 a, std::int32_t b) {
  return {a.low + b, a.high + b};
}
inline __attribute__((always_inline)) Int8 operator*(Int8 a, std::int32_t b) {
  return {a.low * b, a.high * b};
}
inline __attribute__((always_inline)) Int8 operator>>(Int8 a, std::int32_t b) {
  return {a.low >> b, a.high >> b};
}
inline __attribute__((always_inline)) Int8 operator~(Int8 a) {
  return {~a.low, ~a.high};
}
inline __attribute__((always_inline)) void operator+=(Float8& a, Float8 b) {
  a = a + b;
}
#endif
using Mask8 = Int8;
using Short16 = std::uint16_t __attribute__((vector_size(32)));
using Byte4 = std::uint8_t __attribute__((vector_size(4)));
using Byte16 = std::uint8_t __attribute__((vector_size(16)));

/// Eight pixels as floats. Written out for x86 and ARM, where GCC would move the bytes one by one.
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
#elif defined(__ARM_NEON)
  const uint16x8_t shorts = vmovl_u8(vld1_u8(pixels));
  return {vcvtq_f32_u32(vmovl_u16(vget_low_u16(shorts))), vcvtq_f32_u32(vmovl_u16(vget_high_u16(shorts)))};
#else
  Byte4 bytes[2];
  __builtin_memcpy(bytes, pixels, sizeof bytes);
  return {__builtin_convertvector(__builtin_convertvector(bytes[0], Int4), Float4),
          __builtin_convertvector(__builtin_convertvector(bytes[1], Int4), Float4)};
#endif
}

/// What a register of this instruction set holds, for loops in which no lane needs another: there GCC's own
/// comparisons and scalars are fast.
#if defined(__AVX__)
using Wide = Float8;
using WideMask = Mask8;
inline __attribute__((always_inline)) Wide loadWidePixels(const std::uint8_t* pixels) {
  return loadPixels(pixels);
}
#else
using Wide = Float4;
using WideMask = Int4;
inline __attribute__((always_inline)) Wide loadWidePixels(const std::uint8_t* pixels) {
#if defined(__SSE2__)
  const __m128i zero = _mm_setzero_si128();
  int bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  return _mm_cvtepi32_ps(_mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(bytes), zero), zero));
#elif defined(__ARM_NEON)
  std::uint32_t bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  const uint16x8_t shorts = vmovl_u8(vcreate_u8(bytes));
  return vcvtq_f32_u32(vmovl_u16(vget_low_u16(shorts)));
#else
  Byte4 bytes;
  __builtin_memcpy(&bytes, pixels, sizeof bytes);
  return __builtin_convertvector(__builtin_convertvector(bytes, Int4), Float4);
#endif
}
#endif
constexpr int kWideLanes = sizeof(Wide) / sizeof(float);

/// The value in every lane.
inline __attribute__((always_inline)) Float8 broadcast(float value) {
  return Float8{value, value, value, value, value, value, value, value};
}

inline __attribute__((always_inline)) Float8 load(const float* values) {
  Float8 vector;
  __builtin_memcpy(&vector, values, sizeof vector);
  return vector;
}

inline __attribute__((always_inline)) void store(float* values, Float8 vector) {
  __builtin_memcpy(values, &vector, sizeof vector);
}

// Comparisons, lane by lane.
#if defined(__AVX__)
inline __attribute__((always_inline)) Mask8 greater(Float8 a, Float8 b) {
  return a > b;
}
inline __attribute__((always_inline)) Mask8 atLeast(Float8 a, Float8 b) {
  return a >= b;
}
inline __attribute__((always_inline)) Mask8 less(Int8 a, Int8 b) {
  return a < b;
}
#else
inline __attribute__((always_inline)) Mask8 greater(Float8 a, Float8 b) {
  return {a.low > b.low, a.high > b.high};
}
inline __attribute__((always_inline)) Mask8 atLeast(Float8 a, Float8 b) {
  return {a.low >= b.low, a.high >= b.high};
}
inline __attribute__((always_inline)) Mask8 less(Int8 a, Int8 b) {
  return {a.low < b.low, a.high < b.high};
}
#endif

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
