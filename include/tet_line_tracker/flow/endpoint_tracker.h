#pragma once

#include <memory>
#include <vector>

#include "tet_line_tracker/geometry/line_segment.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// What a line looks like in one image: patches along it at each pyramid level, with their gradients (paper:
/// the gradients come from the first image alone). Buffers are kept: made for one set of parameters and
/// filled again and again by EndpointTracker::describe(). Move-only.
class LineTemplate {
 public:
  LineTemplate();
  ~LineTemplate();
  LineTemplate(LineTemplate&&) noexcept;
  LineTemplate& operator=(LineTemplate&&) noexcept;

 private:
  friend class EndpointTracker;
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Outcome of following one line.
struct EndpointFlow {
  enum class Status {
    kTracked,
    kNoSolution,   ///< too little texture, or the iterations ran away
    kOutside,      ///< an endpoint left the image
    kHighResidual  ///< the gray values do not match
  };
  Status status{Status::kNoSolution};
  LineSegment segment;  ///< in the second image [px]
  /// Mean absolute gray difference, 0..1: of the worse end's patch, or of all patches where both ends move
  /// together.
  float residual{0.0F};
};

/// TET, Algorithm 1 of the paper: follows both endpoints of a segment from one image to the next by iterative
/// Lucas-Kanade flow over the pyramid, coarse to fine. Const and thread-safe once made.
class EndpointTracker {
 public:
  /// Throws std::invalid_argument when check() finds a broken rule.
  explicit EndpointTracker(const EndpointTrackerParameters& parameters);

  /// Takes the patches of `segment` from the first image.
  void describe(const ImagePyramid& first, const LineSegment& segment, LineTemplate& patches) const;

  /// Follows the line of `patches` into the second image, from where it is expected there.
  EndpointFlow track(const LineTemplate& patches, const ImagePyramid& second,
                     const LineSegment& expected) const;

 private:
  EndpointTrackerParameters parameters_;
};

}  // namespace tet_line_tracker
