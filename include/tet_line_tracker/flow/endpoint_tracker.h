#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include <opencv2/core.hpp>

#include "tet_line_tracker/geometry/line_bend.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

struct PatchRow;

/// What a line looks like in one image: patches along it at each pyramid level, with their gradients (paper:
/// the gradients come from the first image alone). Buffers are kept and filled again and again by
/// EndpointTracker::extractTemplate(). Move-only.
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
    kNoSolution,   ///< too little texture, or the iterations diverged
    kOutside,      ///< an endpoint left the image
    kHighResidual  ///< the gray values do not match
  };
  Status status{Status::kNoSolution};
  LineSegment segment;  ///< in the second image [px]
  /// Mean absolute gray difference on the finest level, 0..1: of the worse endpoint's patch (two-endpoint
  /// flow), or of all patches (joint flow).
  float residual{0.0F};
};

/// Places that a line may have moved to, along the way that the movement of the camera leaves open.
struct LinePath {
  static constexpr std::size_t kMaxSteps = 32;
  /// Of the line, if both its ends were as far along the way. An end may be at one step and the other at
  /// another.
  std::array<LineSegment, kMaxSteps> chords;
  std::size_t count{0};
  std::size_t expected{0};  ///< step that is most likely
  LineBend bend;
};

/// TET, Algorithm 1 of the paper: follows both endpoints of a segment from one image to the next by iterative
/// Lucas-Kanade flow over the pyramid, coarse to fine. Derived classes say how the two movement vectors are
/// estimated on one level. Const and thread-safe once made.
class EndpointTracker {
 public:
  virtual ~EndpointTracker() = default;

  /// Where the flow begins: kFar on the coarsest level, kNear on the finest, for a line that is within a few
  /// pixels of where it is expected.
  enum class Reach { kFar, kNear };

  /// Takes the patches along `line` from the first image: all that track() needs for this reach.
  void extractTemplate(const ImagePyramid& first, const LineCurve& line, LineTemplate& patches,
                       Reach reach = Reach::kFar) const;
  /// Takes from the same image what a template for kFar has more than one for kNear, if that is missing. Its
  /// level 0 is not read.
  void extendTemplate(const ImagePyramid& first, LineTemplate& patches) const;

  /// Follows the line of `patches` into the second image, from where it is expected there. Throws
  /// std::invalid_argument when `patches` were extracted with another window size, or for kNear when `reach`
  /// is kFar.
  EndpointFlow track(const LineTemplate& patches, const ImagePyramid& second, const LineCurve& expected,
                     Reach reach = Reach::kFar) const;

  /// The places on `path` at which the patches fit best on the coarsest level, best first; at most
  /// best.size(). Returns how many there are. Throws as track() does for kFar.
  static constexpr std::size_t kMaxStarts = 3;
  std::size_t search(const LineTemplate& patches, const ImagePyramid& second, const LinePath& path,
                     std::array<LineSegment, kMaxStarts>& best) const;

 protected:
  using Status = EndpointFlow::Status;

  struct Layout {
    int finest_level;         ///< the flow ends there
    std::size_t max_patches;  ///< along the line on each level, at least 2: one at each end
    bool zero_mean;           ///< patches without their mean, for flow that matches gain and offset
  };
  /// Throws std::invalid_argument when check() finds a broken rule.
  EndpointTracker(const EndpointTrackerParameters& parameters, const Layout& layout);

  const EndpointTrackerParameters& parameters() const { return parameters_; }

 private:
  int finestLevel(const LineTemplate::Content& content) const;
  void extractLevel(const ImagePyramid& first, int level, LineTemplate::Content& content) const;
  void checkContent(const LineTemplate::Content& content, Reach reach) const;

  /// Moves the chord of `line` [px of the level] from where it is expected to where it is; the bend stays.
  /// Sets the residual on the finest level.
  virtual Status trackOnLevel(const PatchRow& row, const cv::Mat& image, bool finest, LineCurve& line,
                              float& residual) const = 0;

  EndpointTrackerParameters parameters_;
  Layout layout_;
};

/// As published: each endpoint by the patch around it, gray values as they are, on all levels.
std::unique_ptr<EndpointTracker> makeTwoEndpointFlow(const EndpointTrackerParameters& parameters);

/// Both movement vectors m1 and m2 in one 4x4 system from patches along the segment: a patch at fraction s
/// moves by (1 - s) m1 + s m2.
std::unique_ptr<EndpointTracker> makeJointFlow(const EndpointTrackerParameters& parameters);

}  // namespace tet_line_tracker
