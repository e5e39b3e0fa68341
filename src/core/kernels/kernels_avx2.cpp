#include "kernels_inline.h"

namespace tet_line_tracker {
namespace kernels {

extern const KernelTable kAvx2Kernels;
const KernelTable kAvx2Kernels = makeTable("avx2");

}  // namespace kernels
}  // namespace tet_line_tracker
