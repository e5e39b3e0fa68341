#include "light.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tet_line_tracker {

LightOptions parseLight(const std::string& text) {
  LightOptions options;
  std::istringstream in(text);
  std::string word;
  while (std::getline(in, word, ',')) {
    if (word == "low") {
      options.low = true;
    } else if (word == "gain_jumps") {
      options.gain_jumps = true;
    } else if (word == "drift") {
      options.drift = true;
    } else if (word != "normal") {
      throw std::invalid_argument("light \"" + word +
                                  "\" is not known; known: normal, low, gain_jumps, drift");
    }
  }
  return options;
}

LightSchedule::LightSchedule(const LightOptions& options, std::uint64_t seed)
    : options_(options), random_(seed, 5) {}

double LightSchedule::nextGain(double time_s) {
  double gain = 1.0;
  if (options_.gain_jumps) {
    const double lowest = std::max(0.6, 0.5 / jumping_gain_);
    const double highest = std::min(1.2, 1.1 / jumping_gain_);
    jumping_gain_ *= random_.uniform(lowest, highest);
    gain *= jumping_gain_;
  }
  if (options_.drift) {
    constexpr double kPeriod = 9.0;  // [s]
    gain *= std::exp(0.45 * std::sin(2.0 * M_PI * time_s / kPeriod)) / std::exp(0.2);
  }
  return gain;
}

}  // namespace tet_line_tracker
