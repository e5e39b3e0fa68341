#pragma once

#include <vector>

namespace tet_line_tracker {

/// Threshold above which one of `values` is an outlier: their median, plus eight times their median absolute
/// deviation (MAD), plus `margin`. Infinite for fewer than ten values, too few to say what is usual. Reorders
/// `values`.
float madThreshold(std::vector<float>& values, float margin);

}  // namespace tet_line_tracker
