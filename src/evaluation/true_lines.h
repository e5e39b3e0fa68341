#pragma once

#include <cstdint>
#include <unordered_map>

#include "scene_truth.h"
#include "simulation/counter_random.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

struct TrueLinesOptions {
  int max_lines{60};  ///< in an image, those longest in view first; 1 or more
  double noise_px{
      0.3};  ///< standard deviation of each end across the line, new in each image, 0 or more [px]
  double min_length_px{30};  ///< [px]
  std::uint64_t seed{1};     ///< of the noise
};

/// The edges of a simulated world as a perfect tracker would give them: what is visible of each, under one id
/// for as long as it is. To compare with in an estimator.
class TrueLines {
 public:
  /// `truth` must outlive this. Throws std::invalid_argument that names the option at fault.
  TrueLines(const SceneTruth& truth, const TrueLinesOptions& options);

  /// Lines of the next image, oldest id first. Images come in the order of their stamps.
  LineFrame next(std::int64_t stamp_ns);

 private:
  struct Track {
    std::uint64_t id;
    std::uint32_t age;
  };

  const SceneTruth& truth_;
  TrueLinesOptions options_;
  RandomSequence random_;
  std::unordered_map<std::size_t, Track> tracks_;  ///< of the image before, by edge
  std::uint64_t next_id_{0};
  std::uint64_t image_count_{0};
};

}  // namespace tet_line_tracker
