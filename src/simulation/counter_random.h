#pragma once

#include <cmath>
#include <cstdint>

namespace tet_line_tracker {

// Random numbers that are a pure function of what they are for, so that neither the order of computation nor
// the number of threads nor the standard library changes a simulated image.

/// Mixes 64 bits well (the finaliser of splitmix64).
inline std::uint64_t hash64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

inline std::uint64_t hash64(std::uint64_t a, std::uint64_t b) {
  return hash64(hash64(a) ^ b);
}

/// Uniform on [0, 1).
inline double uniformFromBits(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// About normal, mean 0, variance 1: the sum of the eight bytes; cheap, and no value beyond 5.
inline float normalFromBits(std::uint64_t bits) {
  constexpr std::uint64_t kEvenBytes = 0x00ff00ff00ff00ffULL;
  std::uint64_t sums = (bits & kEvenBytes) + ((bits >> 8U) & kEvenBytes);
  sums = (sums * 0x0001000100010001ULL) >> 48U;
  constexpr float kMean = 8.0F * 127.5F;
  const float deviation = std::sqrt(8.0F * (256.0F * 256.0F - 1.0F) / 12.0F);
  return (static_cast<float>(sums) - kMean) / deviation;
}

/// A sequence of such numbers, for what is computed in one fixed order.
class RandomSequence {
 public:
  RandomSequence(std::uint64_t seed, std::uint64_t purpose) : key_(hash64(seed, purpose)) {}

  std::uint64_t bits() { return hash64(key_, count_++); }
  double uniform(double low, double high) { return low + (high - low) * uniformFromBits(bits()); }
  double normal() { return static_cast<double>(normalFromBits(bits())); }
  /// 0 .. n - 1
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }

 private:
  std::uint64_t key_;
  std::uint64_t count_{0};
};

}  // namespace tet_line_tracker
