#include <stdexcept>

#include "../../src/tools/datasets/text_table.h"
#include "fuzz_target.h"

namespace {

/// What a row gives; errors about its fields are promised.
template <typename Read>
void readField(Read read) {
  try {
    read();
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static tet_line_tracker::InputFile file(".csv");
  const std::string& path = file.write(data, size);
  try {
    for (const tet_line_tracker::TextRow& row : tet_line_tracker::readTextTable(path, 8)) {
      readField([&row] { row.nanoseconds(0); });
      readField([&row] { row.seconds(0); });
      readField([&row] {
        if (!row.vector(1).allFinite()) throw std::logic_error("a vector is not finite");
      });
      readField([&row] {
        if (!row.poseScalarFirst(1).matrix().allFinite()) throw std::logic_error("a pose is not finite");
      });
      readField([&row] {
        if (!row.poseScalarLast(1).matrix().allFinite()) throw std::logic_error("a pose is not finite");
      });
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
