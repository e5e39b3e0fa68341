#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "counter_random.h"

namespace tet_line_tracker {

struct LightOptions {
  bool low{false};         ///< mean gray about 15, exposure four times longer
  bool gain_jumps{false};  ///< factor of 0.6 to 1.2 from image to image
  bool drift{false};       ///< slow auto-exposure
  bool daylight{false};    ///< outdoors: exposure of 2 ms, as KITTI's cameras
};

/// Reads "normal" or a comma-separated list of low, gain_jumps, drift. Throws std::invalid_argument for
/// others.
LightOptions parseLight(const std::string& text);

/// How bright each image is: gain over what the mean over the sequence asks for.
class LightSchedule {
 public:
  LightSchedule(const LightOptions& options, std::uint64_t seed);

  double exposureSeconds() const { return (options_.daylight ? 0.002 : 0.005) * (options_.low ? 4.0 : 1.0); }
  double meanGray() const { return options_.low ? 15.0 : 105.0; }
  /// Gain of the next image, taken at `time_s`. Jumps stay within 0.5 to 1.1, so that no image drowns or
  /// saturates.
  double nextGain(double time_s);

 private:
  LightOptions options_;
  RandomSequence random_;
  double jumping_gain_{1.0};
};

}  // namespace tet_line_tracker
