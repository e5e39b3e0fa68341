#include "tracking/mad_threshold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tet_line_tracker {
namespace {

constexpr float kDeviations = 8.0F;
constexpr std::size_t kMinValues = 10;

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

float madThreshold(std::vector<float>& values, float margin) {
  if (values.size() < kMinValues) return std::numeric_limits<float>::infinity();
  const float centre = median(values);
  for (float& value : values) value = std::abs(value - centre);
  return centre + kDeviations * median(values) + margin;
}

}  // namespace tet_line_tracker
