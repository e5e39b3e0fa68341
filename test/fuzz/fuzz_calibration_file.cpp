#include <stdexcept>

#include "fuzz_target.h"
#include "tet_line_tracker/camera/calibration_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static tet_line_tracker::InputFile file(".yaml");
  const std::string& path = file.write(data, size);
  try {
    const auto calibration = tet_line_tracker::readCalibrationFile(path);
    tet_line_tracker::makeCameraModel(calibration.camera);
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {  // a camera that the file may hold and no model can be
  }
  return 0;
}
