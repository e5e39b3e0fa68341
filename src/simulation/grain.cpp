#include "grain.h"

#include <algorithm>
#include <cmath>

#include "counter_random.h"

namespace tet_line_tracker {
namespace {

constexpr int kSize = 512;
constexpr float kCellsPerMetre = 125.0F;

std::size_t index(int size, int x, int y) {
  return static_cast<std::size_t>(y & (size - 1)) * static_cast<std::size_t>(size) +
         static_cast<std::size_t>(x & (size - 1));
}

float smooth(float t) {
  return t * t * (3.0F - 2.0F * t);
}

/// Smooth noise with one random value every `period` cells.
void addOctave(std::vector<float>& values, std::uint64_t seed, int period, float amplitude) {
  const int lattice = kSize / period;
  const auto random = [&](int i, int j) {
    return normalFromBits(hash64(seed + static_cast<std::uint64_t>(period), index(lattice, i, j)));
  };
  for (int y = 0; y < kSize; ++y) {
    const float ty = smooth(static_cast<float>(y % period) / static_cast<float>(period));
    for (int x = 0; x < kSize; ++x) {
      const float tx = smooth(static_cast<float>(x % period) / static_cast<float>(period));
      const int i = x / period;
      const int j = y / period;
      const float above = random(i, j) * (1.0F - tx) + random(i + 1, j) * tx;
      const float below = random(i, j + 1) * (1.0F - tx) + random(i + 1, j + 1) * tx;
      values[index(kSize, x, y)] += amplitude * (above * (1.0F - ty) + below * ty);
    }
  }
}

}  // namespace

Grain::Grain(std::uint64_t seed) {
  Level finest{kSize, std::vector<float>(static_cast<std::size_t>(kSize) * kSize, 0.0F)};
  addOctave(finest.values, seed, 1, 0.35F);
  addOctave(finest.values, seed, 4, 0.5F);
  addOctave(finest.values, seed, 16, 0.6F);
  addOctave(finest.values, seed, 64, 0.7F);
  addOctave(finest.values, seed, 256, 0.5F);
  double mean = 0.0;
  double square = 0.0;
  for (const float value : finest.values) {
    mean += value;
    square += static_cast<double>(value) * value;
  }
  const auto n = static_cast<double>(finest.values.size());
  mean /= n;
  const double deviation = std::sqrt(square / n - mean * mean);
  for (float& value : finest.values) value = static_cast<float>((value - mean) / deviation);
  levels_.push_back(std::move(finest));
  while (levels_.back().size > 4) {
    const Level& fine = levels_.back();
    Level coarse{fine.size / 2, {}};
    coarse.values.resize(static_cast<std::size_t>(coarse.size) * static_cast<std::size_t>(coarse.size));
    for (int y = 0; y < coarse.size; ++y) {
      for (int x = 0; x < coarse.size; ++x) {
        coarse.values[index(coarse.size, x, y)] =
            0.25F *
            (fine.values[index(fine.size, 2 * x, 2 * y)] + fine.values[index(fine.size, 2 * x + 1, 2 * y)] +
             fine.values[index(fine.size, 2 * x, 2 * y + 1)] +
             fine.values[index(fine.size, 2 * x + 1, 2 * y + 1)]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

float Grain::sample(const Level& level, float x, float y) {
  // Cell centres of coarser levels lie between those of the finer ones.
  const float scale = static_cast<float>(level.size) / static_cast<float>(kSize);
  x = x * scale - 0.5F;
  y = y * scale - 0.5F;
  const float x0 = std::floor(x);
  const float y0 = std::floor(y);
  const float tx = x - x0;
  const float ty = y - y0;
  const int i = static_cast<int>(x0);
  const int j = static_cast<int>(y0);
  const int size = level.size;
  const float above =
      level.values[index(size, i, j)] * (1.0F - tx) + level.values[index(size, i + 1, j)] * tx;
  const float below =
      level.values[index(size, i, j + 1)] * (1.0F - tx) + level.values[index(size, i + 1, j + 1)] * tx;
  return above * (1.0F - ty) + below * ty;
}

float Grain::at(float u, float v, float footprint) const {
  const float x = u * kCellsPerMetre;
  const float y = v * kCellsPerMetre;
  const float level = std::log2(std::max(1.0F, footprint * kCellsPerMetre));
  const auto finer = std::min(static_cast<std::size_t>(level), levels_.size() - 1);
  const std::size_t coarser = std::min(finer + 1, levels_.size() - 1);
  const float t = std::min(1.0F, level - static_cast<float>(finer));
  const float fine = sample(levels_[finer], x, y);
  return t == 0.0F ? fine : fine * (1.0F - t) + t * sample(levels_[coarser], x, y);
}

}  // namespace tet_line_tracker
