#include "kernels_inline.h"

namespace tet_line_tracker {
namespace kernels {

extern const KernelTable kBaselineKernels;
const KernelTable kBaselineKernels = makeTable("baseline");

}  // namespace kernels
}  // namespace tet_line_tracker
