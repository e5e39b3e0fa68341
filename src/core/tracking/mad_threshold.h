#pragma once

#include <vector>

namespace tet_line_tracker {

/// Value above which one of `values` is an outlier among the others: their median, plus eight times the
/// median distance from it, plus `margin`. Infinite for fewer than ten values, too few to say what is usual.
/// Reorders `values`.
float outlierLimit(std::vector<float>& values, float margin);

}  // namespace tet_line_tracker
