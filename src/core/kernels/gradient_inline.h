// The gradient loops; included by kernels_inline.h, to whose rules they keep. Plain loops on 16-bit integers,
// which the compiler turns into vectors; integers give the same values on every instruction set.
#include "kernels.h"

namespace tet_line_tracker {
namespace kernels {
namespace {

inline __attribute__((always_inline)) std::int16_t absolute(std::int16_t value) {
  return static_cast<std::int16_t>(value < 0 ? -value : value);
}

void gradientRow(const std::uint8_t* const rows[5], int width, std::int16_t* __restrict smooth,
                 std::int16_t* __restrict slope, Gradient* __restrict gradient,
                 std::int16_t* __restrict magnitude) {
  const std::uint8_t* __restrict r0 = rows[0];
  const std::uint8_t* __restrict r1 = rows[1];
  const std::uint8_t* __restrict r2 = rows[2];
  const std::uint8_t* __restrict r3 = rows[3];
  const std::uint8_t* __restrict r4 = rows[4];
  for (int x = 0; x < width; ++x) {
    smooth[x] = static_cast<std::int16_t>(r0[x] + r4[x] + 4 * (r1[x] + r3[x]) + 6 * r2[x]);
    slope[x] = static_cast<std::int16_t>(r4[x] - r0[x] + 2 * (r3[x] - r1[x]));
  }
  for (int x = 2; x < width - 2; ++x) {
    const auto dx =
        static_cast<std::int16_t>(smooth[x + 2] - smooth[x - 2] + 2 * (smooth[x + 1] - smooth[x - 1]));
    const auto dy = static_cast<std::int16_t>(slope[x - 2] + slope[x + 2] +
                                              4 * (slope[x - 1] + slope[x + 1]) + 6 * slope[x]);
    gradient[x].dx = dx;
    gradient[x].dy = dy;
    magnitude[x] = static_cast<std::int16_t>((absolute(dx) + absolute(dy)) & ~kFlags);
  }
}

void findPeaks(const std::int16_t* __restrict magnitude, std::ptrdiff_t stride,
               const Gradient* __restrict gradient, int width, std::int16_t threshold,
               std::uint8_t* __restrict peaks) {
  const std::int16_t* __restrict above = magnitude - stride;
  const std::int16_t* __restrict below = magnitude + stride;
  for (int x = 2; x < width - 2; ++x) {
    const std::int16_t m = magnitude[x];
    const std::int16_t gx = absolute(gradient[x].dx);
    const std::int16_t gy = absolute(gradient[x].dy);
    const int strong = m >= threshold;
    const int in_row = (m > magnitude[x - 1]) & (m >= magnitude[x + 1]) & (gx >= gy);
    const int in_column = (m > above[x]) & (m >= below[x]) & (gx < gy);
    peaks[x] =
        static_cast<std::uint8_t>(strong & in_row) | static_cast<std::uint8_t>(2 * (strong & in_column));
  }
}

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
