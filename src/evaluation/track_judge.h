#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tet_line_tracker/tracking/line_frame.h"
#include "truth.h"

namespace tet_line_tracker {

/// A segment lifted into the world: what a tracker should still see in other images.
class LiftedSegment {
 public:
  /// Lifts points spread over `line` of the image with `stamp_ns`, on the straight line between its
  /// undistorted ends. `truth` must outlive this.
  LiftedSegment(const Truth& truth, std::int64_t stamp_ns, const TrackedLine& line);

  /// Median signed and absolute distance of the lifted points to the infinite (undistorted) line through
  /// `other` of another image, hidden points left out [px]. Points outside the picture count only when fewer
  /// than three are inside. Nothing when no point can be compared.
  struct Error {
    double signed_px;
    double absolute_px;
  };
  std::optional<Error> errorOf(std::int64_t stamp_ns, const TrackedLine& other) const;

  /// At least half of the points are in the picture of `stamp_ns` and not hidden, and the part of the segment
  /// between them is at least `min_length` long [px].
  bool inView(std::int64_t stamp_ns, double min_length) const;

 private:
  static constexpr std::size_t kPoints = 9;

  const Truth& truth_;
  std::array<std::optional<WorldPoint>, kPoints> points_;
};

}  // namespace tet_line_tracker
