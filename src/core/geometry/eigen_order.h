#pragma once

// Compiled before everything else on 64-bit ARM (src/core/CMakeLists.txt). Eigen 3.4 knows vectors of two
// floats there and sums three floats as (a + b) + c; on x86, where the shortest vector has four, as a + (b +
// c). With the vectors of four alone the sums are the same.
#include <Eigen/Core>

namespace Eigen {
namespace internal {

template <int Size>
struct find_best_packet<float, Size> {
  using type = packet_traits<float>::type;
};

}  // namespace internal
}  // namespace Eigen
