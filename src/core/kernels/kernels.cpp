#include "kernels.h"

namespace tet_line_tracker {
namespace kernels {

extern const KernelTable kBaselineKernels;
#ifdef TET_HAVE_AVX2_KERNELS
extern const KernelTable kAvx2Kernels;
#endif

const KernelTable* const* available(int* count) {
#ifdef TET_HAVE_AVX2_KERNELS
  static const KernelTable* const tables[] = {&kBaselineKernels, &kAvx2Kernels};
  *count = __builtin_cpu_supports("avx2") ? 2 : 1;
#else
  static const KernelTable* const tables[] = {&kBaselineKernels};
  *count = 1;
#endif
  return tables;
}

const KernelTable& active() {
  static const KernelTable& best = []() -> const KernelTable& {
    int count = 0;
    const KernelTable* const* tables = available(&count);
    return *tables[count - 1];
  }();
  return best;
}

}  // namespace kernels
}  // namespace tet_line_tracker
